// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/chart_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "analysis/canvas.hpp"
#include "analysis/chart_figure.hpp"
#include "analysis/chart_measure.hpp"
#include "analysis/chart_peers.hpp"
#include "analysis/chart_sweep.hpp"
#include "apps/render/progress.hpp"
#include "apps/render/report.hpp"
#include "apps/render/run_output.hpp"
#include "tessera/program/film.hpp"
#include "tessera/program/options.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/program/printable.hpp"
#include "tessera/statistics.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;
using analysis::no_room;
using OrderedJson = nlohmann::ordered_json;

constexpr double bounds[] = {1e-2, 1e-3, 1e-4, 1e-5};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// The options of `tessera render` for this method.
std::string options_text(const analysis::ChartMethod& method, bool is_grid) {
  if (!method.preset.empty()) return "--preset " + method.preset;
  const Settings& s = method.settings;
  if (method.ranks > 1)
    return fmt::format("mpirun -n {}, --exchange {} --partition random", method.ranks,
                       exchange_word(exchange_of(s, false)));
  std::vector<std::string> words;
  if (!s.mesh.device.backends.empty()) {
    const bool fragment = s.mesh.device.method == GlMethod::fragment;
    words.push_back(fmt::format("--backend osmesa --compositor {}", fragment ? "gl-fragment" : "gl-compute"));
    if (fragment) words.push_back(fmt::format("--framebuffer {}", s.mesh.device.half ? "half" : "float"));
  }
  if (s.mesh.rasterizer == Rasterizer::device) words.emplace_back("--rasterizer device");
  if (s.mesh.rasterizer == Rasterizer::scanline) words.emplace_back("--rasterizer scanline");
  if (s.integrator.kind == IntegratorKind::automatic)
    words.push_back(fmt::format("--accuracy {:g}", s.integrator.accuracy));
  else
    words.push_back("--integrator " + (is_grid ? method_word(s.integrator.kind) : method_line(s.integrator)));
  if (is_grid && takes_steps(s.integrator)) words.push_back(fmt::format("--step {:g}", s.grid.step));
  if (!s.use.lattice) words.emplace_back("--without lattice");
  if (!s.integrator.terminates) words.emplace_back("--without termination");
  return fmt::format("{}", fmt::join(words, " "));
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
      fmt::print("  {:<{}}  left out: {}\n", p.name, widest, printable(p.left_out));
  }
  if (!crowded.empty()) fmt::print("  {}: {}\n", no_room, crowded);
}

OrderedJson point_json(const analysis::ChartPoint& p) {
  OrderedJson json = {{"family", p.family}, {"name", p.name}, {"options", p.options}};
  if (!p.measured()) {
    json["left_out"] = p.left_out;
    return json;
  }
  json["prepare_ms"] = p.prepare_ms;
  json["frame_ms"] = p.frame_ms;
  json["median_ms"] = p.median_ms();
  json["max_error"] = p.error.finite ? OrderedJson(p.error.max) : OrderedJson("not finite");
  json["rms_error"] = p.error.rms;
  json["error_999"] = p.error.finite ? OrderedJson(p.error.p999) : OrderedJson("not finite");
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

}  // namespace

void chart(const OptionWords& words) {
  const auto begin = Clock::now();
  const RenderOptions options = render_options(words);
  const double budget = words.positive("budget-seconds").value_or(60);
  const int repeat = words.count("repeat", 1, 1000).value_or(5);
  std::optional<std::size_t> pixels;
  assign(pixels, words.count("pixels", 1));
  const std::vector<std::string>& figures = words.words("figure");
  const std::string &json = words.word("json"), &csv = words.word("csv");
  for (const auto& figure : figures) analysis::check_figure_path(figure);
  for (const auto& file : figures) check_output(file, options.input());
  for (const auto& file : {json, csv})
    if (!file.empty()) check_output(file, options.input());

  const FilmFrame frame = plan_film(options.plan).front();
  StatusLine line(shows_progress(options.quiet));
  ReadOptions read_options = options.read;
  read_options.progress = line.listener();
  line.begin("reading " + options.input().filename().string());
  const Dataset data = options.open(frame.data.files, read_options);
  OrderedJson report = analysis::program_json();
  report[data.is_grid() ? "volume" : "mesh"] = analysis::data_json(options.input(), described(data));
  const auto loaded = transfer_function_of(data, options);
  const View view{frame.view(data.bounds(), options.projection), frame.size};
  report["transfer_function"] = analysis::transfer_function_json(loaded);
  report["view"] = analysis::view_json(view.camera, view.size);
  const Settings& settings = options.settings;
  const analysis::ChartScene scene{
      data, view, loaded.function, settings.emission, settings.threads, settings.memory_bytes};

  // Reading the data is required for any method, so its time is measured once.
  const double reading = seconds_since(begin);
  const auto read = Clock::now();
  line.begin("rendering the reference");
  const analysis::ChartTruth truth = analysis::chart_truth(scene, budget / 3, pixels);
  const auto methods = analysis::chart_methods(scene);
  std::size_t finished = 0;
  const auto show_progress = [&](const analysis::ChartPoint& point) {
    line.advance(static_cast<double>(++finished) / static_cast<double>(methods.size()));
    if (options.quiet) return;
    const auto away = StatusLine::away();
    fmt::print(stderr, "{}: {:.4g} ms, max {:.3g}\n", point.name, point.median_ms(), point.error.max);
  };
  line.begin("measuring methods");
  analysis::ChartSweep measured = analysis::sweep(scene, methods, truth, {read, budget, repeat}, show_progress);
  line.begin("");
  auto& points = measured.points;
  std::vector<analysis::ChartPoint> alone;
  for (std::size_t i = 0; i < methods.size(); ++i) {
    points[i].options = options_text(methods[i], data.is_grid());
    points[i].left_out = with_options(points[i].left_out);
    // Methods that need mpirun or switch optimizations off are in the chart, but are not recommended.
    if (methods[i].recommended()) alone.push_back(points[i]);
  }
  for (const auto& file : words.words("peer"))
    for (analysis::ChartPoint& peer : analysis::read_peers(file, view.size, truth.pixels, truth.values)) {
      alone.push_back(peer);
      points.push_back(std::move(peer));
    }
  analysis::mark_front(points);

  const std::string what =
      fmt::format("{}, {}x{}, {}", options.input().filename().string(), view.size.width, view.size.height,
                  truth.whole_image ? "every pixel" : fmt::format("{} random pixels", truth.pixels.size()));
  const std::string where = fmt::format("{}, {}, {:.0f} s and {:.0f} s for reading", transfer_function_line(loaded),
                                        instruction_set(), seconds_since(read), reading);
  fmt::print("{}; {}\n", printable(what), printable(where));
  print_table(points);
  fmt::print(
      "errors: largest, RMS and 99.9 % quantile of the differences in linear RGBA from the double-precision reference, "
      "over {};\nvisible: percentage of these pixels with a Delta E 2000 above 1, composited over black; * no other "
      "method is both faster and more accurate; tables of the\ntransfer function are made before a method's first "
      "frame, in prepare_ms of the JSON\n",
      truth.whole_image ? "every pixel"
                        : "a random sample of the pixels: the largest error of the image may be larger");
  if (measured.missing_seconds > 0)
    fmt::print("--budget-seconds {:.0f} would, as a rough estimate, suffice for all\n",
               std::ceil(1.1 * (seconds_since(read) + measured.missing_seconds)));
  OrderedJson fastest = OrderedJson::array();
  for (const double bound : bounds) {
    const analysis::ChartPoint* best = analysis::fastest_within(alone, bound);
    OrderedJson entry = {{"bound", bound}};
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
  report["instruction_set"] = instruction_set();
  report["seconds"] = seconds_since(read);
  report["reading_seconds"] = reading;
  report["methods"] = OrderedJson::array();
  for (const analysis::ChartPoint& p : points) report["methods"].push_back(point_json(p));
  report["fastest"] = fastest;
  if (!json.empty()) write_json(report, json);
  if (!csv.empty()) write_text(csv, csv_of(points));
  for (const auto& figure : figures) analysis::write_chart(points, what, where, figure);
}

}  // namespace tessera::apps
