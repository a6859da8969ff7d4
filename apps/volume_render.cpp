#include "apps/volume_render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include "apps/frame_list.hpp"
#include "apps/mesh_input.hpp"
#include "apps/output_check.hpp"
#include "apps/run_output.hpp"
#include "apps/verify.hpp"
#include "apps/volume_input.hpp"
#include "io/chrome_trace.hpp"
#include "reference/grid_reference.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

const char* word(volume::Method method) {
  constexpr std::array words = {"auto", "exact", "sampled", "preintegrated"};
  return words[static_cast<std::size_t>(method)];
}

std::string method_words(const volume::RenderSettings& settings) {
  std::string words = word(settings.method);
  if (settings.method == volume::Method::automatic) words += fmt::format(" to {:g}", settings.accuracy);
  if (settings.method == volume::Method::sampled || settings.method == volume::Method::preintegrated)
    words += fmt::format(" every {:g} voxels", settings.step);
  if (settings.shading) words += ", shaded";
  return words;
}

/// What one frame gave.
struct Made {
  scene::Camera camera;
  volume::RenderStatistics statistics;
  std::vector<double> frame_ms;
  std::optional<Verification> verification;
};

Json method_json_of(const RenderOptions& options) {
  const volume::RenderSettings& s = options.volume_settings;
  Json json = {{"integrator", word(s.method)}};
  if (s.method == volume::Method::automatic) json["accuracy"] = s.accuracy;
  if (s.method == volume::Method::sampled || s.method == volume::Method::preintegrated) json["step"] = s.step;
  json["emission"] = s.emission == scene::Emission::absorption ? "absorption" : "independent";
  json["shade"] = s.shading.has_value();
  json["backend"] = "cpu";
  json["blend"] = options.display_blend ? "display" : "linear";
  json["threads"] = s.threads;
  json["brick_size"] = s.brick_size;
  json["cache"] = s.cache == volume::CachePolicy::lru ? "lru" : "proximity";
  json["memory_bytes"] = s.memory_bytes;
  return json;
}

Json made_json(const Frame& frame, const Made& made) {
  const volume::RenderStatistics& s = made.statistics;
  Json outputs = Json::array();
  for (const auto& output : frame.outputs) outputs.push_back(output.string());
  Json json = {{"number", frame.number}, {"outputs", outputs}, {"skipped", false}, {"time", frame.mesh.time}};
  json["view"] = view_json(made.camera, frame.size);
  json["frame_ms"] = made.frame_ms;
  json["counters"] = {{"rays", s.rays},
                      {"voxels_visited", s.voxels_visited},
                      {"samples", s.samples},
                      {"bricks_total", s.bricks_total},
                      {"bricks_invisible", s.bricks_invisible},
                      {"brick_hits", s.brick_hits},
                      {"bricks_loaded", s.bricks_loaded},
                      {"bricks_evicted", s.bricks_evicted},
                      {"bytes_loaded", s.bytes_loaded},
                      {"bytes_resident", s.bytes_resident},
                      {"peak_bytes", s.peak_bytes},
                      {"blank_samples", s.blank_samples}};
  json["instruction_set"] = s.instruction_set;
  if (made.verification) json["verify"] = verification_json(*made.verification);
  return json;
}

/// The largest error that is promised, in linear RGBA; none where steps decide it.
std::optional<double> promised(const volume::RenderSettings& settings) {
  if (settings.method == volume::Method::automatic) return settings.accuracy;
  if (settings.method == volume::Method::exact) return 1e-5;
  return std::nullopt;
}

Verification verified(const scene::Image& image, const scene::SampleSource& source, const scene::Camera& camera,
                      const scene::TransferFunction& function, const RenderOptions& options) {
  constexpr std::uint64_t seed = 1;
  const reference::GridReference reference(source, camera, image.size, function, options.volume_settings.emission);
  const auto pixels = reference::random_pixels(image.size, static_cast<std::size_t>(options.verify), seed);
  Verification verification;
  verification.bound = promised(options.volume_settings);
  const double bound = verification.bound.value_or(std::numeric_limits<double>::infinity());
  verification.judgement = reference::judge(image, reference, bound, pixels, options.volume_settings.threads);
  return verification;
}

/// One run's volume, transfer function and renderer. Of a time series one step is held at a time; the first gives
/// transfer function and view.
class VolumeRun {
 public:
  VolumeRun(const RenderOptions& options, scene::Trace* trace, const Frame& first)
      : options_(options), trace_(trace), file_(opened(first)) {}

  [[nodiscard]] const io::VolumeFile& file() const { return file_; }
  [[nodiscard]] const io::LoadedTransferFunction& transfer_function() const { return loaded_; }

  Made make(const Frame& frame) {
    hold(frame);
    Made made;
    made.camera = view_of(frame, box_, options_.projection);
    if (trace_ != nullptr) trace_->set_frame(frame.number);
    scene::Image image;
    double frame_begin = 0;
    for (int i = 0; i < std::max(options_.repeat, 1); ++i) {
      image = {};
      if (trace_ != nullptr && i > 0) trace_->add_frame(frame.number, frame_begin);
      if (trace_ != nullptr) frame_begin = trace_->now_us();
      const auto start = Clock::now();
      image = renderer_->render(made.camera, frame.size, loaded_.function, &made.statistics);
      made.frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    {
      const scene::TraceScope scope(trace_, "write");
      write_pictures(image, {}, frame, options_);
    }
    if (trace_ != nullptr) trace_->add_frame(frame.number, frame_begin);
    if (options_.verify > 0) {
      const scene::TraceScope scope(trace_, "verify");
      made.verification = verified(image, *file_.source, made.camera, loaded_.function, options_);
    }
    return made;
  }

 private:
  [[nodiscard]] io::VolumeFile opened(const Frame& frame) const {
    const scene::TraceScope scope(trace_, "read");
    return io::open_volume(frame.mesh.files.front(), options_.volume);
  }

  void hold(const Frame& frame) {
    if (frame.step != step_) {
      renderer_.reset();
      file_ = {};
      file_ = opened(frame);
      step_ = frame.step;
    }
    if (renderer_) return;
    volume::RenderSettings settings = options_.volume_settings;
    settings.trace = trace_;
    renderer_.emplace(*file_.source, settings);
  }

  const RenderOptions& options_;
  scene::Trace* trace_;
  io::VolumeFile file_;
  std::size_t step_ = 0;
  scene::Box box_ = scene::bounds(file_.source->geometry());
  io::LoadedTransferFunction loaded_ = transfer_function_of(facts_of(file_), options_);
  std::optional<volume::Renderer> renderer_;
};

std::string volume_run_line(const RenderOptions& options, const VolumeRun& run, const std::vector<Frame>& frames,
                            const Frame& first, const Made& made) {
  const io::VolumeFile& file = run.file();
  const volume::RenderStatistics& s = made.statistics;
  std::string line = fmt::format("{}: {}; field {} ({}) {:.6g} to {:.6g}; {}; view {}, {}x{}", options.input.string(),
                                 samples_line(file), file.source->grid().field_name,
                                 file.source->geometry().association == scene::Association::point ? "point" : "cell",
                                 file.range.low, file.range.high, transfer_function_line(run.transfer_function()),
                                 view_line(made.camera), first.size.width, first.size.height);
  if (frames.size() > 1) line += fmt::format(" (frame {} of {})", first.number + 1, frames.size());
  line += fmt::format("; {} of {} bricks invisible, {} loaded; {} voxels visited; {}, {}, {:.3g} ms",
                      s.bricks_invisible, s.bricks_total, s.bricks_loaded, s.voxels_visited,
                      method_words(options.volume_settings), s.instruction_set, made.frame_ms.front());
  for (const auto& note : file.notes) line += fmt::format("; {}", note);
  return line;
}

void refuse_mesh_options(const RenderOptions& options) {
  const auto refuse = [](const char* option) {
    throw scene::bad_input(fmt::format("{}: is for meshes, and the input is a volume; leave it out", option));
  };
  if (options.deep) throw scene::bad_input("deep picture: volumes give none yet; name an .exr, .png or .pfm");
  if (options.settings.rasterizer != frame::Rasterizer::planes) refuse("--rasterizer");
  if (options.mesh.smooth) refuse("--smooth");
  if (options.mesh.max_volume) refuse("--max-volume");
  if (options.mesh.time_step) refuse("--time-step");
  if (!options.mesh.plot3d_q.empty()) refuse("--q");
  if (options.verify > 0 && options.volume_settings.shading)
    throw scene::bad_input("--verify: the reference does not shade; leave --shade out");
}

}  // namespace

scene::ExitCode render_volume(const RenderOptions& options) {
  refuse_mesh_options(options);
  const auto frames = list_frames(options);
  check_outputs(options, frames);
  Progress progress(options.progress, frames.size());
  scene::Trace trace;
  std::optional<VolumeRun> run;  // nothing is read if every frame is there already
  Json report = {{"program", "tessera"}, {"version", TESSERA_VERSION}, {"method", method_json_of(options)}};
  Json frame_reports = Json::array();
  std::size_t done = 0, rendered = 0;
  bool met = true;
  for (const auto& frame : frames) {
    if (frame.finished) {
      frame_reports.push_back(frame_json(frame, nullptr));
      progress.update(++done, rendered);
      continue;
    }
    if (!run) run.emplace(options, options.timing.empty() ? nullptr : &trace, frames.front());
    const Made made = run->make(frame);
    frame_reports.push_back(made_json(frame, made));
    progress.clear();
    if (rendered == 0 && !options.quiet)
      fmt::print(stderr, "{}\n", volume_run_line(options, *run, frames, frame, made));
    if (frames.size() > 1 && !options.quiet)
      fmt::print(stderr, "frame {} of {}: {} voxels visited, {:.3g} ms\n", frame.number + 1, frames.size(),
                 made.statistics.voxels_visited, made.frame_ms.front());
    if (options.repeat > 0) fmt::print("{}\n", frame_ms_line(made.frame_ms));
    if (made.verification) {
      fmt::print("{}\n", verification_line(*made.verification, frame.number));
      met = met && made.verification->met();
    }
    progress.update(++done, ++rendered);
  }
  progress.clear();
  if (run) {
    report["volume"] = volume_json(options.input, run->file());
    report["transfer_function"] = transfer_function_json(run->transfer_function());
  } else if (!options.quiet) {
    fmt::print(stderr, "{}: all {} frames are there already, nothing rendered\n", options.input.string(),
               frames.size());
  }
  report["frames"] = frame_reports;
  if (!options.report.empty()) write_json(report, options.report);
  if (!options.timing.empty()) {
    const std::vector<std::string> events{io::chrome_trace_events(trace, 0, "rank 0")};
    io::TraceRun traced = run ? trace_run(options, 0, frames.front(), rendered) : io::TraceRun{};
    traced.rasterizer.clear();
    traced.integrator = word(options.volume_settings.method);
    io::write_chrome_trace(events, traced, options.timing);
  }
  return met ? scene::ExitCode::complete : scene::ExitCode::accuracy_not_met;
}

}  // namespace tessera::apps
