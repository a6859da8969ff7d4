// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <utility>

#include "apps/render/empty_picture.hpp"
#include "apps/render/film_traces.hpp"
#include "apps/render/frame_writer.hpp"
#include "apps/render/planned_frames.hpp"
#include "apps/render/report.hpp"
#include "apps/render/run_output.hpp"
#include "apps/render/shown_step.hpp"
#include "tessera/session.hpp"
#include "tessera/statistics.hpp"
#include "tessera/view.hpp"

namespace tessera::apps {
namespace {

/// The times of the input's steps. One rank reads them.
std::vector<double> times_in(const RenderOptions& options, Job& job) {
  std::vector<double> times;
  if (job.rank() == 0) times = times_of(*options.first, options.read);
  const auto raw = std::as_bytes(std::span(times));
  const std::vector<std::byte> bytes = job.broadcast(0, {raw.begin(), raw.end()});
  times.resize(bytes.size() / sizeof(double));
  std::memcpy(times.data(), bytes.data(), bytes.size());
  return times;
}

/// One rank's part of a run: the loop over its frames. `ShownStep` contains the data, `FrameWriter` writes the files,
/// and `RunOutput` prints and reports.
class Film final : public Sink {
 public:
  Film(const RenderOptions& options, Job& job)
      : options_(options),
        job_(job),
        roles_(options.is_grid()
                   ? Roles{}
                   : assign_roles(job.size(), options.settings.ranks.projectors, options.settings.ranks.compositors)),
        writing_rank_(options.is_grid() ? 0 : roles_.assembler()),
        writes_(job.rank() == writing_rank_),
        overlaps_(!options.is_grid() && (job.size() > 1 || !options.settings.mesh.device.backends.empty())),
        frames_(planned_frames(options)),
        traces_(!options.timing.empty(), overlaps_),
        output_(options_, frames_, job.size(), writes_),
        step_(options_, frames_, output_, job, writing_rank_, traces_.rendering()),
        frame_writer_(options_, frames_, traces_, writes_) {}

  ExitCode run() {
    job_.require_same_files();  // the plan depends on these files
    agree_on_finished_frames();
    for (std::size_t first = 0; first < frames_.size();) {
      // The frames of one step are rendered together, because they share the open data.
      std::vector<std::size_t> group;
      std::size_t last = first;
      for (; last < frames_.size() && frames_[last].step == frames_[first].step; ++last)
        if (!frames_[last].finished) group.push_back(last);
      if (!group.empty()) {
        step_.show(frames_[group.front()]);
        if (overlaps_) output_.note("job", job_json(options_, job_.size(), roles_));
        overlaps_ || grids_overlap(group) ? render_overlapping(group) : render_one_by_one(group);
      }
      first = last;
    }
    frame_writer_.finish();
    step_.warn_at_end(empty_);
    if (traces_.rendering() != nullptr) write_trace();
    const std::vector<std::byte> code = {static_cast<std::byte>(output_.finish())};
    return static_cast<ExitCode>(job_.broadcast(writing_rank_, code)[0]);
  }

  [[nodiscard]] bool wants_tiles() const override { return false; }

  /// Called on the writing rank if frames overlap: once for every repetition of every frame, in order.
  void frame(RenderedFrame&& rendered) override {
    if (!writes_) return;
    const std::size_t at = listed_[rendered.number];
    frame_ms_.push_back(rendered.statistics.milliseconds);
    if (rendered.number + 1 < listed_.size() && listed_[rendered.number + 1] == at)
      return frame_writer_.spare_images().keep(std::move(rendered.image));
    const auto number = static_cast<std::int32_t>(listed_before_ + rendered.number);
    finish(frames_[at], {frame_writer_.reusing(std::move(rendered)), annotated(frames_[at]), number});
  }

  Image spare_image(ImageSize size) override { return frame_writer_.spare_images().take(size); }

 private:
  /// All ranks use the list of finished frames that the writing rank finds on its disk.
  void agree_on_finished_frames() {
    if (writes_) {
      check_annotation(options_.annotation);
      PictureWriter::check(options_, frames_);
      const std::array inputs = {options_.input(), options_.plan.cameras, options_.read.plot3d_q,
                                 std::filesystem::path(options_.transfer_function)};
      check_film_outputs(frames_, other_outputs(options_), inputs);
    }
    std::vector<std::byte> finished(frames_.size());
    for (std::size_t i = 0; i < frames_.size(); ++i) finished[i] = std::byte{frames_[i].finished};
    finished = job_.broadcast(writing_rank_, std::move(finished));
    for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i].finished = finished[i] != std::byte{0};
  }

  [[nodiscard]] std::string rendering_words(const FilmFrame& frame) const {
    return frames_.size() > 1 ? "rendering the next"
                              : fmt::format("rendering {}x{}", frame.size.width, frame.size.height);
  }

  [[nodiscard]] AnnotatedFrame annotated(const FilmFrame& frame) const {
    return {frame, step_.camera(frame), step_.data(), step_.function(), options_};
  }

  /// Whether several images of a volume overlap: rays of one image are cast while the previous image is gathered.
  [[nodiscard]] bool grids_overlap(const std::vector<std::size_t>& group) const {
    const FrameSettings& frame = options_.frame;
    return options_.is_grid() && job_.size() > 1 && group.size() > 1 && !frame.deep && !frame.peel && !frame.keep_cost;
  }

  void render_one_by_one(const std::vector<std::size_t>& group) {
    Trace* const trace = traces_.rendering();
    for (const std::size_t at : group) {
      const FilmFrame& frame = frames_[at];
      const View view{step_.camera(frame), frame.size};
      if (trace != nullptr) trace->set_frame(frame.number);
      double began_us = 0;
      RenderedFrame rendered;
      for (int i = 0; i < std::max(options_.repeat, 1); ++i) {
        rendered = {};  // free the last image's memory before the next one
        // The span of the last repetition also includes writing.
        if (trace != nullptr && i > 0) trace->add_frame(frame.number, began_us);
        if (trace != nullptr) began_us = trace->now_us();
        output_.line().begin(rendering_words(frame));
        FrameProgress progress(output_.line(), frame.size);
        rendered = step_.session().render(view, step_.function(), options_.frame,
                                          output_.line().shown() ? &progress : nullptr);
        frame_ms_.push_back(rendered.statistics.milliseconds);
      }
      if (!writes_) {
        if (trace != nullptr) trace->add_frame(frame.number, began_us);
        continue;
      }
      if (!frame.outputs.empty()) output_.line().begin("writing " + frame.outputs.front().filename().string());
      FinishedFrame finished{std::make_shared<const RenderedFrame>(std::move(rendered)), annotated(frame),
                             frame.number};
      // The images are drawn now, because the session may already render the next frame when a thread writes this one.
      if (options_.show_balance)
        finished.balance = step_.session().balance_pictures(*finished.rendered, view, step_.function());
      if (trace != nullptr) finished.began_us = began_us;
      finish(frame, std::move(finished));
    }
  }

  void render_overlapping(const std::vector<std::size_t>& group) {
    listed_.clear();
    std::vector<View> views;
    for (const std::size_t at : group)
      for (int repetition = 0; repetition < std::max(options_.repeat, 1); ++repetition) {
        listed_.push_back(at);
        views.push_back({step_.camera(frames_[at]), frames_[at].size});
      }
    output_.line().begin(rendering_words(frames_[group.front()]));
    Trace* const trace = traces_.rendering();
    if (options_.is_grid() && trace != nullptr) trace->set_frame(static_cast<std::int32_t>(listed_before_));
    step_.session().render(views, step_.function(), options_.frame, *this);
    listed_before_ += listed_.size();
  }

  /// Called on the writing rank: writes, verifies and reports a frame.
  void finish(const FilmFrame& frame, FinishedFrame finished) {
    const std::shared_ptr<const RenderedFrame> rendered = finished.rendered;
    FrameRecord record;
    record.camera = finished.annotated.camera;
    record.statistics = rendered->statistics;
    record.frame_ms = std::exchange(frame_ms_, {});
    frame_writer_.add(std::move(finished));
    if (options_.verify > 0) {
      const TraceScope scope(traces_.writing(), "verify");
      output_.line().begin(fmt::format("verifying {} pixels", options_.verify));
      record.verification = step_.session().verify(*rendered, {record.camera, frame.size}, step_.function(),
                                                   static_cast<std::size_t>(options_.verify));
    }
    empty_.examine(static_cast<std::size_t>(&frame - frames_.data()), *rendered, step_.data(), step_.function(),
                   options_);
    check_light(rendered->image);
    output_.add(frame, record);
  }

  /// Warns of the first image whose light is so bright that rounding to 32-bit floats causes an error of more than a
  /// quarter of the promised error.
  void check_light(const Image& image) {
    // With absorption, light is at most the brightest colour.
    const bool may_be_bright = options_.settings.emission == Emission::independent || step_.function().max_color() > 1;
    const std::optional<double> promised = step_.session().promised_error();
    if (warned_of_light_ || !may_be_bright || !promised || image.rgba.empty()) return;
    const float brightest = *std::max_element(image.rgba.begin(), image.rgba.end());
    const double rounding = brightest * 0x1p-24;
    if (rounding <= *promised / 4) return;
    warned_of_light_ = true;
    output_.warn(fmt::format(
        "the brightest pixel has the value {:.3g}, which 32-bit floats round by up to {:.2g}; the accuracy {:.2g} is "
        "not kept; give `{}--accuracy {:.1g}`, or a transfer function with darker colours",
        brightest, rounding, *promised,
        options_.settings.integrator.kind == IntegratorKind::exact ? "--integrator auto " : "", 8 * rounding));
  }

  void write_trace() {
    step_.close_session();  // the session's spans must end before they are written
    TraceRun traced;
    std::string process = fmt::format("rank {}", job_.rank());
    if (step_.is_open() || (overlaps_ && !options_.is_grid()))
      traced = trace_run(options_, step_.tets(), frames_.front(), output_);
    if (options_.is_grid()) {
      traced.ranks = job_.size();
      traced.integrator = method_word(options_.settings.integrator.kind);
    } else if (overlaps_) {
      traced.ranks = job_.size();
      traced.projectors = static_cast<int>(roles_.projectors.size());
      traced.compositors = static_cast<int>(roles_.compositors.size());
      traced.exchange = exchange_word(exchange_of(options_.settings, options_.frame.deep || options_.frame.peel));
      const bool projects = roles_.projects(job_.rank()), composites = roles_.composites(job_.rank());
      process += projects && composites ? " projector + compositor" : projects ? " projector" : " compositor";
    }
    tessera::write_trace(*traces_.rendering(), process, traced, options_.timing, job_.communicator(), writing_rank_);
  }

  RenderOptions options_;  ///< completed after the data have been read
  Job& job_;
  const Roles roles_;  ///< used for meshes
  const int writing_rank_;
  const bool writes_, overlaps_;
  std::vector<FilmFrame> frames_;
  FilmTraces traces_;
  RunOutput output_;
  ShownStep step_;
  EmptyPictures empty_;
  bool warned_of_light_ = false;
  std::vector<double> frame_ms_;     ///< times of the current frame's repetitions
  std::vector<std::size_t> listed_;  ///< frames of the current list, each once per repetition
  std::size_t listed_before_ = 0;    ///< number of frames in earlier lists
  FrameWriter frame_writer_;         ///< must be last: uses the members above until all frames are written
};

}  // namespace

ExitCode render(const RenderOptions& options, Job& job) {
  if (!takes_steps_of_file(options.plan)) return Film(options, job).run();
  RenderOptions planned = options;
  planned.plan.file_times = times_in(options, job);
  planned.plan.file_steps = planned.plan.file_times.size();
  return Film(planned, job).run();
}

}  // namespace tessera::apps
