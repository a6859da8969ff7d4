#include "apps/render_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "apps/frame_list.hpp"
#include "apps/mesh_input.hpp"
#include "apps/output_check.hpp"
#include "apps/progress.hpp"
#include "apps/report.hpp"
#include "apps/verify.hpp"
#include "io/atomic_file.hpp"
#include "io/chrome_trace.hpp"
#include "scene/trace.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

/// `frame_ms median X min Y`, milliseconds. The median of an even number is the mean of the middle two.
std::string frame_ms_line(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const std::size_t middle = times.size() / 2;
  const double median = times.size() % 2 == 1 ? times[middle] : (times[middle - 1] + times[middle]) / 2;
  return fmt::format("frame_ms median {:.3f} min {:.3f}", median, times.front());
}

/// One run's mesh, transfer function and renderer, and what they give.
class Run {
 public:
  Run(const RenderOptions& options, scene::Trace* trace) : options_(options), trace_(trace), file_(read()) {
    settings_.trace = trace;
    renderer_.emplace(file_.mesh, settings_);
    box_ = scene::bounds(file_.mesh);
  }

  [[nodiscard]] const io::MeshFile& file() const { return file_; }
  [[nodiscard]] const io::LoadedTransferFunction& transfer_function() const { return loaded_; }

  /// Renders, verifies if asked, and writes the frame's pictures.
  FrameRecord make(const Frame& frame) {
    FrameRecord record;
    record.camera = view_of(frame, box_, options_.projection);
    if (trace_ != nullptr) trace_->set_frame(frame.number);
    double frame_begin = 0;
    const auto end_frame = [&] {
      if (trace_ != nullptr) trace_->add_frame(frame.number, frame_begin);
    };
    scene::Image image;
    for (int i = 0; i < std::max(options_.repeat, 1); ++i) {
      image = {};              // the last one's memory before the next one's
      if (i > 0) end_frame();  // the last repetition's span holds the writing too
      if (trace_ != nullptr) frame_begin = trace_->now_us();
      const auto start = Clock::now();
      image = renderer_->render(record.camera, frame.size, loaded_.function, &record.statistics);
      record.frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    {
      const scene::TraceScope scope(trace_, "write");
      for (const auto& output : frame.outputs) io::write_image(image, output, options_.image);
    }
    end_frame();
    if (options_.verify > 0) {
      const scene::TraceScope scope(trace_, "verify");
      record.verification =
          verify(image, file_.mesh, record.camera, loaded_.function, options_.settings, options_.verify);
    }
    return record;
  }

 private:
  [[nodiscard]] io::MeshFile read() const {
    const scene::TraceScope scope(trace_, "read");
    return read_input(options_.input, options_.mesh);
  }

  const RenderOptions& options_;
  scene::Trace* trace_;
  io::MeshFile file_;
  io::LoadedTransferFunction loaded_ = transfer_function_of(file_.mesh, options_);
  frame::RenderSettings settings_ = options_.settings;
  std::optional<frame::Renderer> renderer_;
  scene::Box box_;
};

void write_json(const Json& json, const std::filesystem::path& path) {
  io::AtomicFile file(path);
  // A file name need not be UTF-8; JSON must.
  file.write(json.dump(2, ' ', false, Json::error_handler_t::replace));
  file.write("\n");
  file.commit();
}

io::TraceRun trace_run(const RenderOptions& options, const Run& run, const Frame& frame, std::size_t rendered) {
  const Json method = method_json(options);
  io::TraceRun traced;
  traced.version = TESSERA_VERSION;
  traced.input = options.input.string();
  traced.tets = run.file().mesh.tets.size();
  traced.frames = static_cast<int>(rendered) * std::max(options.repeat, 1);
  traced.width = frame.size.width;
  traced.height = frame.size.height;
  traced.threads =
      options.settings.threads > 0 ? options.settings.threads : static_cast<int>(std::thread::hardware_concurrency());
  traced.rasterizer = method.value("rasterizer", "planes");
  traced.integrator = method.at("integrator");
  return traced;
}

Json report_head(const RenderOptions& options) {
  return {{"program", "tessera"}, {"version", TESSERA_VERSION}, {"method", method_json(options)}};
}

}  // namespace

scene::ExitCode render(const RenderOptions& options) {
  const auto frames = list_frames(options);
  check_outputs(options, frames);

  Json report = report_head(options);
  Json frame_reports = Json::array();
  bool met = true;
  std::size_t done = 0, rendered = 0;

  scene::Trace trace;
  std::optional<Run> run;  // nothing is read if every frame is there already
  Progress progress(options.progress, frames.size());
  for (const auto& frame : frames) {
    if (frame.finished) {
      frame_reports.push_back(frame_json(frame, nullptr));
      progress.update(++done, rendered);
      continue;
    }
    const bool first = !run;
    if (first) run.emplace(options, options.timing.empty() ? nullptr : &trace);
    const FrameRecord record = run->make(frame);
    frame_reports.push_back(frame_json(frame, &record));
    if (first && !options.quiet) {
      progress.clear();
      fmt::print(stderr, "{}\n", run_line(options, run->file(), run->transfer_function(), frames, frame, record));
    }
    if (options.repeat > 0) fmt::print("{}\n", frame_ms_line(record.frame_ms));
    if (record.verification) {
      fmt::print("{}\n", verification_line(*record.verification, frame.number));
      met = met && record.verification->met();
    }
    progress.update(++done, ++rendered);
  }
  progress.clear();

  if (run) {
    report["mesh"] = mesh_json(options.input, run->file());
    report["transfer_function"] = transfer_function_json(run->transfer_function());
  } else if (!options.quiet) {
    fmt::print(stderr, "{}: all {} frames are there already, nothing rendered\n", options.input.string(),
               frames.size());
  }
  report["frames"] = frame_reports;
  if (!options.report.empty()) write_json(report, options.report);
  if (!options.timing.empty()) {
    const std::vector<std::string> events{io::chrome_trace_events(trace, 0, "rank 0")};
    io::write_chrome_trace(events, run ? trace_run(options, *run, frames.front(), rendered) : io::TraceRun{},
                           options.timing);
  }
  return met ? scene::ExitCode::complete : scene::ExitCode::accuracy_not_met;
}

}  // namespace tessera::apps
