#include "apps/render_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "apps/distributed_render.hpp"
#include "apps/frame_list.hpp"
#include "apps/mesh_input.hpp"
#include "apps/output_check.hpp"
#include "apps/run_output.hpp"
#include "apps/volume_render.hpp"
#include "frame/verify.hpp"
#include "io/chrome_trace.hpp"
#include "scene/trace.hpp"

namespace tessera::apps {
namespace {

using Clock = std::chrono::steady_clock;

/// One run's mesh, transfer function and renderer, and what they give. Of a time series one step is held at a time; the
/// first gives transfer function and view.
class Run {
 public:
  Run(const RenderOptions& options, scene::Trace* trace, const Frame& first)
      : options_(options), trace_(trace), file_(read(first, options.mesh)) {
    settings_.trace = trace;
  }

  [[nodiscard]] const MeshSummary& summary() const { return summary_; }
  [[nodiscard]] const colormaps::LoadedTransferFunction& transfer_function() const { return loaded_; }

  /// Renders, verifies if asked, and writes the frame's pictures.
  FrameRecord make(const Frame& frame) {
    hold(frame);
    FrameRecord record;
    record.camera = view_of(frame, summary_.facts.box, options_.projection);
    if (trace_ != nullptr) trace_->set_frame(frame.number);
    double frame_begin = 0;
    const auto end_frame = [&] {
      if (trace_ != nullptr) trace_->add_frame(frame.number, frame_begin);
    };
    scene::Image image;
    scene::DeepImage deep;
    for (int i = 0; i < std::max(options_.repeat, 1); ++i) {
      image = {}, deep = {};   // the last one's memory before the next one's
      if (i > 0) end_frame();  // the last repetition's span holds the writing too
      if (trace_ != nullptr) frame_begin = trace_->now_us();
      const auto start = Clock::now();
      image = renderer_->render(record.camera, frame.size, loaded_.function, &record.statistics,
                                options_.deep ? &deep : nullptr);
      record.frame_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    }
    {
      const scene::TraceScope scope(trace_, "write");
      write_pictures(image, deep, frame, options_);
    }
    end_frame();
    if (options_.verify > 0) {
      const scene::TraceScope scope(trace_, "verify");
      record.verification = frame::verify(image, file_.mesh, record.camera, loaded_.function, options_.settings,
                                          static_cast<std::size_t>(options_.verify));
    }
    return record;
  }

 private:
  [[nodiscard]] io::MeshFile read(const Frame& frame, const io::MeshOptions& options) const {
    const scene::TraceScope scope(trace_, "read");
    return read_input(frame.mesh.files, options);
  }

  /// Makes the frame's step the one at hand. The last one's memory goes before the next one's comes.
  void hold(const Frame& frame) {
    if (frame.step != step_) {
      require_still_there(frame);
      renderer_.reset();
      file_ = {};
      file_ = read(frame, later_options_);
      step_ = frame.step;
    }
    if (renderer_) return;
    frame::order_corners(file_.mesh, settings_);
    renderer_.emplace(file_.mesh, settings_);
  }

  const RenderOptions& options_;
  scene::Trace* trace_;
  io::MeshFile file_;
  std::size_t step_ = 0;  ///< of file_
  io::MeshOptions later_options_ = options_of_later_steps(options_.mesh, file_);
  MeshSummary summary_ = summary_of(file_, options_.settings.threads);
  colormaps::LoadedTransferFunction loaded_ = transfer_function_of(summary_.facts, options_);
  frame::RenderSettings settings_ = options_.settings;
  std::optional<frame::Renderer> renderer_;
};

scene::ExitCode render_alone(const RenderOptions& options) {
  const auto frames = list_frames(options);
  check_outputs(options, frames);

  RunOutput output(options, frames);
  scene::Trace trace;
  std::optional<Run> run;  // nothing is read if every frame is there already
  for (const auto& frame : frames) {
    if (frame.finished) {
      output.skip(frame);
      continue;
    }
    if (!run) {
      run.emplace(options, options.timing.empty() ? nullptr : &trace, frames.front());
      output.describe(run->summary(), run->transfer_function());
    }
    output.add(frame, run->make(frame));
  }
  if (!options.timing.empty()) {
    const std::vector<std::string> events{io::chrome_trace_events(trace, 0, "rank 0")};
    const std::uint64_t tets = run ? run->summary().facts.tets : 0;
    io::write_chrome_trace(events, run ? trace_run(options, tets, frames.front(), output.rendered()) : io::TraceRun{},
                           options.timing);
  }
  return output.finish();
}

}  // namespace

scene::ExitCode render(const RenderOptions& options, exchange::Transport& transport) {
  if (options.is_volume) return render_volume(options, transport);
  // A device is fed by the same exchange in one process, which then is its only rank.
  if (transport.size() > 1 || !options.compositing_on.backends.empty()) return render_on_ranks(options, transport);
  frame::assign_roles(1, options.projectors, options.compositors);  // more than one of either needs mpirun
  return render_alone(options);
}

}  // namespace tessera::apps
