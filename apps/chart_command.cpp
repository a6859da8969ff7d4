#include "apps/chart_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "analysis/canvas.hpp"
#include "analysis/chart_figure.hpp"
#include "analysis/chart_measure.hpp"
#include "analysis/chart_peers.hpp"
#include "apps/argument_values.hpp"
#include "apps/chart_methods.hpp"
#include "apps/frame_list.hpp"
#include "apps/output_check.hpp"
#include "apps/report.hpp"
#include "apps/run_output.hpp"
#include "apps/session_options.hpp"
#include "apps/setting_words.hpp"
#include "apps/volume_input.hpp"
#include "frame/dataset.hpp"
#include "io/atomic_file.hpp"
#include "projection/planes_rasterizer.hpp"
#include "reference/grid_reference.hpp"
#include "reference/reference.hpp"
#include "scene/error.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr double bounds[] = {1e-2, 1e-3, 1e-4, 1e-5};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The pixels that are looked at, and what is right there.
struct Truth {
  std::vector<reference::PixelIndex> pixels;
  std::vector<reference::Pixel> values;
  bool whole_image = false;
  double seconds = 0;
};

Truth truth_of(const ChartScene& scene, double seconds, std::optional<int> asked) {
  const auto start = Clock::now();
  std::unique_ptr<reference::RayReference> reference;
  if (scene.mesh != nullptr)
    reference =
        std::make_unique<reference::Reference>(*scene.mesh, scene.camera, scene.size, scene.function, scene.emission);
  else
    reference = std::make_unique<reference::GridReference>(*scene.volume, scene.camera, scene.size, scene.function,
                                                           scene.emission);
  constexpr std::uint64_t seed = 1;
  const auto total = static_cast<std::size_t>(scene.size.width) * static_cast<std::size_t>(scene.size.height);
  Truth truth;
  const auto look = [&](std::size_t count) {
    truth.pixels = reference::random_pixels(scene.size, count, seed);
    const auto begin = Clock::now();
    truth.values = reference->pixels(truth.pixels, scene.threads);
    return seconds_since(begin);
  };
  if (asked) {
    look(static_cast<std::size_t>(*asked));
  } else {
    // Larger and larger pilots until one says what a pixel costs; passes over the mesh make few as dear as many.
    std::size_t count = std::min<std::size_t>(total, 256);
    for (;;) {
      const double took = look(count);
      const double left = seconds - seconds_since(start);
      if (count == total || took * 2.5 > left) break;
      const double next = static_cast<double>(count) * std::clamp(0.6 * left / std::max(took, 1e-6), 2.0, 16.0);
      count = std::min(total, static_cast<std::size_t>(next));
    }
  }
  truth.whole_image = truth.pixels.size() == total;
  truth.seconds = seconds_since(start);
  return truth;
}

/// What a method takes, before it is tried: by the last of its family, else by the last of the first family.
class CostGuess {
 public:
  [[nodiscard]] double seconds(const ChartMethod& method) const {
    const auto known = families_.find(method.family);
    if (known != families_.end()) return method.cost * known->second;
    return families_.empty() ? 0 : method.cost * families_.at(first_);
  }
  void learn(const ChartMethod& method, double seconds) {
    if (families_.empty()) first_ = method.family;
    families_[method.family] = seconds / method.cost;
  }

 private:
  std::map<std::string, double> families_;  ///< preparation and one frame, over `cost`
  std::string first_;
};

constexpr auto no_room = "no room in the budget";

struct Measured {
  std::vector<analysis::ChartPoint> points;
  double missing_seconds = 0;  ///< what one frame each of the methods without room would take
};

/// The first method is measured in any case.
Measured measure(const ChartScene& scene, const Truth& truth, Clock::time_point begin, double budget, int repeat,
                 bool quiet) {
  const auto methods = chart_methods(scene);
  Measured out;
  CostGuess guess;
  auto waiting = static_cast<double>(
      std::count_if(methods.begin(), methods.end(), [](const ChartMethod& m) { return m.left_out.empty(); }));
  for (const ChartMethod& method : methods) {
    analysis::ChartPoint point;
    point.family = method.family, point.name = method.name, point.options = method.options;
    point.left_out = method.left_out;
    const double left = budget - seconds_since(begin);
    double share = 0;
    if (point.left_out.empty()) {
      share = left / waiting--;
      if (guess.seconds(method) > 0 && guess.seconds(method) > left) {
        point.left_out = no_room;
        out.missing_seconds += guess.seconds(method);
      }
    }
    if (point.left_out.empty()) {
      const auto start = Clock::now();
      try {
        const auto renderer = method.make(scene);
        point.prepare_ms = 1000 * seconds_since(start);
        for (int i = 0; i < repeat; ++i) {
          auto [image, ms] = renderer->frame();
          point.frame_ms.push_back(ms);
          if (i == 0) {
            guess.learn(method, seconds_since(start));
            point.error = analysis::chart_error(image, truth.pixels, truth.values);
          }
          if (seconds_since(start) + ms / 1000 > share) break;
        }
      } catch (const scene::Error& error) {
        point.left_out = with_options(error.what());
        point.frame_ms.clear();
      }
      if (!quiet && point.measured())
        fmt::print(stderr, "{}: {:.4g} ms, max {:.3g}\n", point.name, point.median_ms(), point.error.max);
    }
    out.points.push_back(std::move(point));
  }
  return out;
}

std::string error_words(double error) { return error == 0 ? "0" : fmt::format("{:.2e}", error); }

void print_table(const std::vector<analysis::ChartPoint>& points) {
  std::size_t widest = 8;
  for (const analysis::ChartPoint& p : points) widest = std::max(widest, p.name.size());
  fmt::print("  {:<{}}  {:>9} {:>9} {:>9}  {:>8}  {:>8}  {:>8}  {:>8}\n", "method", widest, "median ms", "min", "max",
             "max err", "RMS", "99.9 %", "visible");
  std::vector<const analysis::ChartPoint*> sorted;
  for (const analysis::ChartPoint& p : points)
    if (p.measured()) sorted.push_back(&p);
  std::sort(sorted.begin(), sorted.end(), [](auto* a, auto* b) { return a->error.max < b->error.max; });
  for (const analysis::ChartPoint* p : sorted)
    fmt::print("{} {:<{}}  {:>9.4g} {:>9.4g} {:>9.4g}  {:>8}  {:>8}  {:>8}  {:>7.3g}%\n", p->on_front ? "*" : " ",
               p->name, widest, p->median_ms(), p->min_ms(), p->max_ms(), error_words(p->error.max),
               error_words(p->error.rms), error_words(p->error.p999), 100 * p->error.visible_share);
  std::string crowded;
  for (const analysis::ChartPoint& p : points) {
    if (p.left_out == no_room)
      crowded += fmt::format("{}{}", crowded.empty() ? "" : ", ", p.name);
    else if (!p.left_out.empty())
      fmt::print("  {:<{}}  left out: {}\n", p.name, widest, p.left_out);
  }
  if (!crowded.empty()) fmt::print("  {}: {}\n", no_room, crowded);
}

Json point_json(const analysis::ChartPoint& p) {
  Json json = {{"family", p.family}, {"name", p.name}, {"options", p.options}};
  if (!p.measured()) {
    json["left_out"] = p.left_out;
    return json;
  }
  json["prepare_ms"] = p.prepare_ms;
  json["frame_ms"] = p.frame_ms;
  json["median_ms"] = p.median_ms();
  json["max_error"] = p.error.finite ? Json(p.error.max) : Json("not finite");
  json["rms_error"] = p.error.rms;
  json["error_999"] = p.error.finite ? Json(p.error.p999) : Json("not finite");
  json["visible_share"] = p.error.visible_share;
  json["front"] = p.on_front;
  return json;
}

std::string csv_of(const std::vector<analysis::ChartPoint>& points) {
  std::string csv =
      "family,name,options,median_ms,min_ms,max_ms,repeats,max_error,rms_error,error_999,visible_share,"
      "front,left_out\n";
  const auto quoted = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('"', at)) != std::string::npos; at += 2) text.insert(at, 1, '"');
    return fmt::format("\"{}\"", text);
  };
  for (const analysis::ChartPoint& p : points)
    if (p.measured())
      csv += fmt::format("{},{},{},{:.6g},{:.6g},{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{},\n", quoted(p.family),
                         quoted(p.name), quoted(p.options), p.median_ms(), p.min_ms(), p.max_ms(), p.frame_ms.size(),
                         p.error.max, p.error.rms, p.error.p999, p.error.visible_share, p.on_front ? 1 : 0);
    else
      csv += fmt::format("{},{},{},,,,,,,,,,{}\n", quoted(p.family), quoted(p.name), quoted(p.options),
                         quoted(p.left_out));
  return csv;
}

/// The words of `render` that this command has, checked and in values.
RenderOptions options_of(const RenderWords& words) {
  RenderOptions options = render_options(words);
  if (options.deep) throw scene::bad_input("chart: makes no pictures; leave -o out");
  return options;
}

}  // namespace

void add_chart_options(CLI::App& command, RenderWords& words, ChartWords& chart) {
  add_mesh_options(command, words);
  command.add_option("--transfer-function", words.transfer_function, "file or preset")->type_name("FILE|PRESET");
  command.add_flag("--rescale", words.rescale, "stretch a transfer function file's values over the field's range");
  command.add_option("--unit-distance", words.unit_distance, "as of render")->type_name("LENGTH");
  command.add_option("--opacity-scale", words.opacity_scale, "multiplies the extinction")->type_name("FACTOR");
  command.add_option("--camera", words.camera, "view; of a list the first one")->type_name("FILE");
  command.add_option("--size", words.size, "pixels (default: the camera file's, else 1024x1024)")->type_name("WxH");
  command.add_option("--projection", words.projection, "of the default view")->type_name("orthographic|perspective");
  command.add_option("--emission", words.emission, "source term")->type_name("absorption|independent");
  command.add_option("--threads", words.threads, "threads (default: all cores)")->type_name("T");
  command.add_option("--memory", words.memory, "budget of frame buffers or bricks")->type_name("SIZE");
  command.add_option("--budget-seconds", chart.budget, "time for all of it but reading (default 60)")->type_name("S");
  command.add_option("--repeat", chart.repeat, "frames a method, if the budget allows (default 5)")->type_name("K");
  command.add_option("--pixels", chart.pixels, "random pixels that errors are taken over (default: what fits)")
      ->type_name("N");
  command.add_option("--peer", chart.peers, "measured pictures of other programs (JSON)")->type_name("FILE");
  command.add_option("--json", chart.json, "everything measured")->type_name("FILE");
  command.add_option("--csv", chart.csv, "the same as a table")->type_name("FILE");
  command.add_option("--figure", chart.figures, "the chart, .svg or .png; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_flag("--quiet", words.quiet, "nothing on stderr but errors");
}

void chart(const RenderWords& words, const ChartWords& chart) {
  const auto begin = Clock::now();
  const RenderOptions options = options_of(words);
  const double budget = parse_positive("--budget-seconds", chart.budget);
  const int repeat = parse_count("--repeat", chart.repeat, 1, 1000);
  std::optional<int> pixels;
  if (!chart.pixels.empty()) pixels = parse_count("--pixels", chart.pixels, 1, std::numeric_limits<int>::max());
  for (const auto& figure : chart.figures) analysis::check_figure_path(figure);
  for (const auto& file : chart.figures) check_output_file(file, options.input);
  for (const auto& file : {chart.json, chart.csv})
    if (!file.empty()) check_output_file(file, options.input);

  const Frame frame = list_frames(options).front();
  ChartScene scene;
  scene.size = frame.size;
  scene.emission = options.settings.emission;
  scene.threads = options.settings.threads;
  scene.memory_bytes = options.settings.memory_bytes;
  const Dataset data = Dataset::open(frame.mesh.files, read_options(options));
  Json report = {{"program", "tessera"}, {"version", TESSERA_VERSION}};
  if (data.is_grid())
    scene.volume = data.state().samples.get();
  else
    scene.mesh = &data.state().mesh;
  report[data.is_grid() ? "volume" : "mesh"] = data_json(options.input, Description(data));
  const auto loaded = transfer_function_of(data, options);
  scene.function = loaded.function;
  scene.camera = view_of(frame, data.bounds(), options.projection);
  report["transfer_function"] = transfer_function_json(loaded);
  report["view"] = view_json(scene.camera, scene.size);

  // Reading is what any use of the data takes, and no choice of the chart's.
  const double reading = seconds_since(begin);
  const auto read = Clock::now();
  const Truth truth = truth_of(scene, budget / 3, pixels);
  Measured measured = measure(scene, truth, read, budget, repeat, options.quiet);
  auto& points = measured.points;
  for (const auto& file : chart.peers)
    for (analysis::ChartPoint& peer : analysis::read_peers(file, scene.size, truth.pixels, truth.values))
      points.push_back(std::move(peer));
  analysis::mark_front(points);

  const std::string what =
      fmt::format("{}, {}x{}, {}", options.input.filename().string(), scene.size.width, scene.size.height,
                  truth.whole_image ? "every pixel" : fmt::format("{} random pixels", truth.pixels.size()));
  const std::string where = fmt::format("{}, {}, {:.0f} s and {:.0f} s for reading", transfer_function_line(loaded),
                                        projection::instruction_set(), seconds_since(read), reading);
  fmt::print("{}; {}\n", what, where);
  print_table(points);
  fmt::print(
      "errors: largest, RMS and 99.9 % of differences in linear RGBA to the double-precision reference, over {};\n"
      "visible: share of these pixels above Delta E 2000 of 1, over black; * none is faster and nearer; tables of the\n"
      "transfer function are made before a method's first frame, in prepare_ms of the JSON\n",
      truth.whole_image ? "every pixel" : "a random sample of the pixels: the image's largest may be larger");
  if (measured.missing_seconds > 0)
    fmt::print("--budget-seconds {:.0f} would, by a rough guess, have room for all\n",
               std::ceil(1.1 * (seconds_since(read) + measured.missing_seconds)));
  Json fastest = Json::array();
  // What needs mpirun, or leaves out what saves work, is on the chart, but no setting to recommend.
  std::vector<analysis::ChartPoint> alone = points;
  std::erase_if(alone, [](const analysis::ChartPoint& p) {
    return p.options.starts_with("mpirun") || p.options.find("--without") != std::string::npos;
  });
  for (const double bound : bounds) {
    const analysis::ChartPoint* best = analysis::fastest_within(alone, bound);
    Json entry = {{"bound", bound}};
    if (best != nullptr) {
      fmt::print("fastest within {:g}: {} ({:.4g} ms){}\n", bound, best->name, best->median_ms(),
                 best->options.empty() ? "" : fmt::format(": {}", best->options));
      entry["name"] = best->name;
      entry["median_ms"] = best->median_ms();
    } else {
      fmt::print("fastest within {:g}: none\n", bound);
    }
    fastest.push_back(entry);
  }
  report["pixels"] = {{"count", truth.pixels.size()}, {"whole_image", truth.whole_image}, {"seconds", truth.seconds}};
  report["instruction_set"] = projection::instruction_set();
  report["seconds"] = seconds_since(read);
  report["reading_seconds"] = reading;
  report["methods"] = Json::array();
  for (const analysis::ChartPoint& p : points) report["methods"].push_back(point_json(p));
  report["fastest"] = fastest;
  if (!chart.json.empty()) write_json(report, chart.json);
  if (!chart.csv.empty()) {
    io::AtomicFile file(chart.csv);
    file.write(csv_of(points));
    file.commit();
  }
  for (const auto& figure : chart.figures) analysis::write_chart(points, what, where, figure);
}

}  // namespace tessera::apps
