#include "apps/volume_render.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/balance_picture.hpp"
#include "apps/distributed_render.hpp"
#include "apps/frame_list.hpp"
#include "apps/frame_reports.hpp"
#include "apps/mesh_input.hpp"
#include "apps/output_check.hpp"
#include "apps/run_output.hpp"
#include "apps/verify.hpp"
#include "apps/volume_input.hpp"
#include "apps/volume_report.hpp"
#include "frame/brick_memory.hpp"
#include "frame/deep_rows.hpp"
#include "frame/scan_together.hpp"
#include "frame/sort_first.hpp"
#include "frame/verify.hpp"
#include "io/chrome_trace.hpp"
#include "io/time_series.hpp"
#include "tessera/version.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;
using exchange::Bytes;

void refuse_mesh_options(const RenderOptions& options) {
  const auto refuse = [&](const char* option) {
    io::require_input(options.input);
    throw scene::bad_input(fmt::format("{}: is for meshes, and the input is a volume; leave it out", option));
  };
  if (options.deep && !frame::promised_error(options.volume_settings))
    throw scene::bad_input(
        fmt::format("deep picture: --integrator {} gives a step other light than its parts; use auto or "
                    "exact",
                    method_word(options.volume_settings.method)));
  if (options.deep && options.volume_settings.shading)
    throw scene::bad_input("deep picture: it is not shaded; leave --shade out");
  if (options.deep && options.show_balance)
    throw scene::bad_input("deep picture: --show balance draws none; name an .exr, .png or .pfm");
  if (options.settings.rasterizer != frame::Rasterizer::planes) refuse("--rasterizer");
  if (options.mesh.smooth) refuse("--smooth");
  if (options.mesh.max_volume) refuse("--max-volume");
  if (options.mesh.time_step) refuse("--time-step");
  if (!options.mesh.plot3d_q.empty()) refuse("--q");
}

/// With --show balance every picture has its cost map beside it.
std::vector<Frame> frames_of(const RenderOptions& options) {
  std::vector<Frame> frames = list_frames(options);
  if (!options.show_balance) return frames;
  for (Frame& frame : frames) {
    const std::size_t pictures = frame.outputs.size();
    for (std::size_t i = 0; i < pictures; ++i) {
      frame.outputs.push_back(cost_name(frame.outputs[i]));
      frame.finished = frame.finished && std::filesystem::exists(frame.outputs.back());
    }
  }
  return frames;
}

/// One rank's part of a run. Of a time series one step is held at a time; the first gives transfer function and view.
class VolumeRun {
 public:
  VolumeRun(const RenderOptions& options, exchange::Transport& transport)
      : options_(options),
        transport_(transport),
        speaks_(transport.rank() == 0),
        frames_(frames_of(options)),
        progress_(options.progress && speaks_, frames_.size()),
        sort_first_(transport, balance()) {}

  scene::ExitCode run() {
    agree_on_finished_frames();
    for (const Frame& frame : frames_) {
      if (frame.finished)
        skip(frame);
      else
        make(frame);
    }
    progress_.clear();
    if (!options_.timing.empty()) write_trace();
    Bytes code(1);
    if (speaks_) code[0] = static_cast<std::byte>(finish());
    return static_cast<scene::ExitCode>(exchange::broadcast(transport_, 0, code)[0]);
  }

 private:
  [[nodiscard]] scene::Trace* trace() { return options_.timing.empty() ? nullptr : &recording_; }

  [[nodiscard]] frame::SortFirstSettings balance() {
    frame::SortFirstSettings settings = options_.balance;
    settings.keep_cost = options_.show_balance;
    settings.keep_doubts = options_.verify > 0;
    settings.trace = trace();
    return settings;
  }

  /// The speaking rank's view of the disk holds for all.
  void agree_on_finished_frames() {
    if (speaks_) check_outputs(options_, frames_);
    Bytes finished(frames_.size());
    for (std::size_t i = 0; i < frames_.size(); ++i) finished[i] = std::byte{frames_[i].finished};
    finished = exchange::broadcast(transport_, 0, std::move(finished));
    for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i].finished = finished[i] != std::byte{0};
  }

  void skip(const Frame& frame) {
    ++done_;
    if (!speaks_) return;
    if (frame_reports_.kept()) frame_reports_.add(volume_frame_json(options_, frame, nullptr));
    progress_.update(done_, rendered_);
  }

  void open(const Frame& frame) {
    require_still_there(frame);
    renderer_.reset();
    file_ = {};
    const std::filesystem::path& path = frame.mesh.files.front();
    {
      const scene::TraceScope scope(trace(), "read");
      file_ = io::open_unscanned_volume(path, options_.volume);
    }
    {
      const scene::TraceScope scope(trace(), "prepare");
      ranges_.emplace(frame::scan_together(transport_, *file_.source, options_.volume_settings.threads));
    }
    io::set_range(file_, path, ranges_->range);
    step_ = frame.step;
    if (box_) return;
    box_ = scene::bounds(file_.source->geometry());
    loaded_ = transfer_function_of(facts_of(file_), options_);
  }

  void hold(const Frame& frame) {
    if (!box_) open(frames_.front());
    if (frame.step != step_) open(frame);
    if (renderer_) return;
    const scene::TraceScope scope(trace(), "prepare");
    volume::RenderSettings settings = options_.volume_settings;
    settings.trace = trace();
    settings.memory_bytes =
        frame::brick_memory(settings.memory_bytes, resident_ + ranges_->bytes(), frame.size, settings.threads);
    renderer_.emplace(*file_.source, settings, std::move(*ranges_));
  }

  void make(const Frame& frame) {
    hold(frame);
    VolumeFrameRecord record;
    record.camera = view_of(frame, *box_, options_.projection);
    if (trace() != nullptr) recording_.set_frame(frame.number);
    std::optional<frame::FinishedVolumeFrame> finished;
    double frame_begin = 0;
    for (int i = 0; i < std::max(options_.repeat, 1); ++i) {
      finished.reset();  // the last one's memory before the next one's
      if (trace() != nullptr && i > 0) recording_.add_frame(frame.number, frame_begin);
      if (trace() != nullptr) frame_begin = recording_.now_us();
      finished = sort_first_.render(*renderer_, loaded_.function, {record.camera, frame.size},
                                    static_cast<std::size_t>(frame.number));
      if (finished) record.frame_ms.push_back(finished->frame_ms);
    }
    std::optional<scene::DeepImage> deep;
    if (options_.deep) {
      const scene::TraceScope scope(trace(), "project");
      deep = frame::deep_rows(transport_, *file_.source, record.camera, frame.size, loaded_.function,
                              {options_.settings.deep_accuracy, options_.volume_settings.emission,
                               options_.volume_settings.threads, options_.volume_settings.memory_bytes},
                              static_cast<std::int32_t>(frame.number));
      if (deep) record.deep_samples = deep->samples.size();
    }
    if (finished) {
      const scene::TraceScope scope(trace(), "write");
      write(*finished, deep ? *deep : scene::DeepImage{}, frame, record.camera);
    }
    if (trace() != nullptr) recording_.add_frame(frame.number, frame_begin);
    ++done_, ++rendered_;
    if (finished) say(frame, *finished, std::move(record));
  }

  void write(const frame::FinishedVolumeFrame& finished, const scene::DeepImage& deep, const Frame& frame,
             const scene::Camera& camera) const {
    if (!options_.show_balance) return write_pictures(finished.image, deep, frame, options_);
    scene::Image shown = finished.image;
    draw_bricks(shown, camera, file_.source->geometry(), renderer_->visible_bricks(loaded_.function), finished.split);
    const scene::Image cost = cost_picture(finished.cost, frame.size, finished.split);
    Frame of_volume = frame, of_cost = frame;
    const auto half = static_cast<std::ptrdiff_t>(frame.outputs.size() / 2);
    of_volume.outputs.erase(of_volume.outputs.begin() + half, of_volume.outputs.end());
    of_cost.outputs.erase(of_cost.outputs.begin(), of_cost.outputs.begin() + half);
    write_pictures(shown, deep, of_volume, options_);
    write_pictures(cost, deep, of_cost, options_);
  }

  /// On rank 0.
  void say(const Frame& frame, const frame::FinishedVolumeFrame& finished, VolumeFrameRecord record) {
    record.statistics = finished.statistics;
    record.split = finished.split;
    record.samples = finished.samples;
    record.cpu_seconds = finished.cpu_seconds;
    if (options_.verify > 0) {
      const scene::TraceScope scope(trace(), "verify");
      record.verification =
          frame::verify(finished.image, *file_.source, record.camera, loaded_.function, options_.volume_settings,
                        finished.doubts, static_cast<std::size_t>(options_.verify));
    }
    if (frame_reports_.kept()) frame_reports_.add(volume_frame_json(options_, frame, &record));
    progress_.clear();
    if (rendered_ == 1 && !options_.quiet)
      fmt::print(stderr, "{}\n", volume_run_line(options_, file_, loaded_, frames_, frame, record));
    if (frames_.size() > 1 && !options_.quiet)
      fmt::print(stderr, "{}\n", volume_frame_line(options_, frames_, frame, record));
    if (options_.repeat > 0) fmt::print("{}\n", frame_ms_line(record.frame_ms));
    if (record.verification) {
      fmt::print("{}\n", verification_line(*record.verification, frame.number));
      met_ = met_ && record.verification->met();
    }
    progress_.update(done_, rendered_);
  }

  void write_trace() {
    transport_.trace_to(nullptr, nullptr);
    io::TraceRun traced = box_ ? trace_run(options_, 0, frames_.front(), rendered_) : io::TraceRun{};
    traced.ranks = transport_.size();
    traced.rasterizer.clear();
    traced.integrator = method_word(options_.volume_settings.method);
    write_rank_traces(transport_, 0, recording_, fmt::format("rank {}", transport_.rank()), traced, options_.timing);
  }

  [[nodiscard]] scene::ExitCode finish() const {
    Json report = {{"program", "tessera"},
                   {"version", TESSERA_VERSION},
                   {"method", volume_method_json(options_, transport_.size())}};
    if (box_) {
      report["volume"] = volume_json(options_.input, file_);
      report["transfer_function"] = transfer_function_json(loaded_);
    } else if (!options_.quiet) {
      fmt::print(stderr, "{}: all {} frames are there already, nothing rendered\n", options_.input.string(),
                 frames_.size());
    }
    if (!options_.report.empty()) frame_reports_.write(report, options_.report);
    return met_ ? scene::ExitCode::complete : scene::ExitCode::accuracy_not_met;
  }

  const RenderOptions& options_;
  exchange::Transport& transport_;
  bool speaks_;
  std::vector<Frame> frames_;
  Progress progress_;
  scene::Trace recording_;
  frame::SortFirst sort_first_;

  io::VolumeFile file_;
  std::size_t step_ = 0;           ///< of file_
  std::optional<scene::Box> box_;  ///< of the first step; none until something is read
  colormaps::LoadedTransferFunction loaded_;
  std::optional<volume::CellRanges> ranges_;  ///< of file_, until its renderer takes them
  std::optional<volume::Renderer> renderer_;
  const std::uint64_t resident_ = frame::resident_bytes();

  FrameReports frame_reports_{!options_.report.empty()};
  std::size_t done_ = 0, rendered_ = 0;
  bool met_ = true;
};

}  // namespace

scene::ExitCode render_volume(const RenderOptions& options, exchange::Transport& transport) {
  refuse_mesh_options(options);
  return VolumeRun(options, transport).run();
}

}  // namespace tessera::apps
