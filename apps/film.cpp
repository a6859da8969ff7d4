#include "apps/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "apps/balance_picture.hpp"
#include "apps/frame_list.hpp"
#include "apps/output_check.hpp"
#include "apps/rank_traces.hpp"
#include "apps/report.hpp"
#include "apps/run_output.hpp"
#include "apps/session_options.hpp"
#include "exchange/collectives.hpp"
#include "frame/session_extras.hpp"
#include "frame/verify.hpp"
#include "io/time_series.hpp"
#include "scene/trace.hpp"

namespace tessera::apps {
namespace {

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
  if (options.settings.rasterizer != Rasterizer::planes) refuse("--rasterizer");
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

/// One rank's part in a run. Of a time series one step is held at a time; the first gives transfer function and view.
class Film final : public Sink {
 public:
  Film(const RenderOptions& options, exchange::Transport& transport)
      : options_(options),
        transport_(transport),
        roles_(options.is_volume ? frame::Roles{}
                                 : frame::assign_roles(transport.size(), options.projectors, options.compositors)),
        writer_(options.is_volume ? 0 : roles_.assembler()),
        writes_(transport.rank() == writer_),
        overlaps_(!options.is_volume && (transport.size() > 1 || !options.compositing_on.backends.empty())),
        frames_(frames_of(options)),
        projecting_(overlaps_ ? scene::TraceRole::projector : scene::TraceRole::both),
        compositing_(projecting_, scene::TraceRole::compositor),
        output_(quiet_ranks(options), frames_, transport.size()) {}

  scene::ExitCode run() {
    agree_on_finished_frames();
    if (overlaps_ && timed()) transport_.trace_to(&projecting_, &compositing_);
    for (std::size_t first = 0; first < frames_.size();) {
      // The frames of one step together: they share what is held.
      std::vector<std::size_t> group;
      std::size_t last = first;
      for (; last < frames_.size() && frames_[last].step == frames_[first].step; ++last)
        if (!frames_[last].finished) group.push_back(last);
      if (!group.empty()) {
        hold(frames_[group.front()]);
        overlaps_ ? make_overlapping(group) : make_one_by_one(group);
      }
      first = last;
    }
    skip_to(frames_.size());
    if (timed()) write_trace();
    const std::uint8_t code = writes_ ? static_cast<std::uint8_t>(output_.finish(options_)) : 0;
    return static_cast<scene::ExitCode>(
        exchange::broadcast_value(transport_, writer_, exchange::MessageKind::exit_code, code));
  }

  [[nodiscard]] bool wants_tiles() const override { return false; }

  /// Of frames that overlap, on the writing rank: every repetition of every frame in order.
  void frame(RenderedFrame&& rendered) override {
    if (!writes_) return;
    const std::size_t at = jobs_[rendered.number];
    frame_ms_.push_back(rendered.statistics.milliseconds);
    if (rendered.number + 1 < jobs_.size() && jobs_[rendered.number + 1] == at) return;
    const Frame& frame = frames_[at];
    FrameRecord record;
    record.camera = camera_of(frame);
    {
      const scene::TraceScope scope(timed() ? &compositing_ : nullptr, "write",
                                    static_cast<std::int32_t>(jobs_before_ + rendered.number));
      write_pictures(rendered.image, rendered.deep, frame, options_);
    }
    say(frame, rendered, std::move(record));
  }

 private:
  [[nodiscard]] bool timed() const { return !options_.timing.empty(); }
  [[nodiscard]] scene::Trace* trace() { return timed() ? &projecting_ : nullptr; }
  /// Where the writing rank's own work goes.
  [[nodiscard]] scene::Trace* writing() { return !timed() ? nullptr : overlaps_ ? &compositing_ : &projecting_; }

  /// Only one rank shows progress.
  const RenderOptions& quiet_ranks(const RenderOptions& options) {
    quiet_.progress = options.progress && writes_;
    return quiet_;
  }

  /// The writing rank's view of the disk holds for all.
  void agree_on_finished_frames() {
    if (writes_) check_outputs(options_, frames_);
    constexpr auto kind = exchange::MessageKind::finished_frames;
    Bytes finished = exchange::begin_message(kind, frames_.size());
    for (const Frame& frame : frames_) exchange::append(finished, std::uint8_t{frame.finished});
    finished = exchange::broadcast(transport_, writer_, std::move(finished));
    exchange::MessageReader reader(finished, writer_, kind);
    for (Frame& frame : frames_) frame.finished = reader.take<std::uint8_t>() != 0;
    reader.finish();
  }

  void skip_to(std::size_t frame) {
    for (; writes_ && next_ < frame; ++next_) output_.skip(options_, frames_[next_]);
  }

  [[nodiscard]] scene::Camera camera_of(const Frame& frame) const { return view_of(frame, *box_, options_.projection); }

  void open(const Frame& frame, const ReadOptions& read) {
    require_still_there(frame);
    session_.reset();  // the last step's memory before the next one's
    data_.reset();
    data_.emplace(frame::open_dataset(frame.mesh.files, read, transport_, settings_.ranks, trace()));
    step_ = frame.step;
  }

  /// Makes the frame's step the one at hand.
  void hold(const Frame& frame) {
    if (!box_) {
      open(frames_.front(), read_);
      box_ = data_->bounds();
      tets_ = data_->tet_count();
      later_read_ = read_of_later_steps(read_, *data_);
      loaded_ = transfer_function_of(*data_, options_);
      if (writes_) output_.describe(Description(*data_), loaded_);
      if (writes_ && overlaps_) output_.note("job", job_json(options_, transport_.size(), roles_, settings_));
    }
    if (frame.step != step_) open(frame, later_read_);
    if (session_) return;
    frame::SessionExtras extras;
    extras.projecting = trace();
    extras.compositing = timed() ? &compositing_ : nullptr;
    extras.compositing_on = options_.compositing_on;
    extras.bounded = options_.settings.bounded;
    extras.keep_cost = options_.show_balance;
    extras.first_frame = static_cast<std::uint32_t>(jobs_before_);
    session_.emplace(frame::make_session(*data_, settings_, transport_, extras));
  }

  [[nodiscard]] FrameSettings frame_settings() const {
    return {options_.deep, options_.settings.deep_accuracy, options_.is_volume && options_.verify > 0};
  }

  void make_one_by_one(const std::vector<std::size_t>& group) {
    for (const std::size_t at : group) {
      const Frame& frame = frames_[at];
      FrameRecord record;
      record.camera = camera_of(frame);
      if (trace() != nullptr) trace()->set_frame(frame.number);
      double frame_begin = 0;
      RenderedFrame rendered;
      for (int i = 0; i < std::max(options_.repeat, 1); ++i) {
        rendered = {};  // the last one's memory before the next one's
        // The last repetition's span holds the writing too.
        if (trace() != nullptr && i > 0) trace()->add_frame(frame.number, frame_begin);
        if (trace() != nullptr) frame_begin = trace()->now_us();
        rendered = session_->render({record.camera, frame.size}, loaded_.function, frame_settings());
        frame_ms_.push_back(rendered.statistics.milliseconds);
      }
      if (writes_) {
        const scene::TraceScope scope(trace(), "write");
        write(rendered, frame, record.camera);
      }
      if (trace() != nullptr) trace()->add_frame(frame.number, frame_begin);
      if (writes_) say(frame, rendered, std::move(record));
    }
  }

  void make_overlapping(const std::vector<std::size_t>& group) {
    jobs_.clear();
    std::vector<View> views;
    for (const std::size_t at : group)
      for (int repetition = 0; repetition < std::max(options_.repeat, 1); ++repetition) {
        jobs_.push_back(at);
        views.push_back({camera_of(frames_[at]), frames_[at].size});
      }
    session_->render(views, loaded_.function, frame_settings(), *this);
    jobs_before_ += jobs_.size();
  }

  void write(const RenderedFrame& rendered, const Frame& frame, const scene::Camera& camera) const {
    if (!options_.show_balance) return write_pictures(rendered.image, rendered.deep, frame, options_);
    const frame::GridBalance balance = frame::balance_of(*session_, loaded_.function);
    scene::Image shown = rendered.image;
    draw_bricks(shown, camera, data_->grid_geometry(), balance.bricks, balance.split);
    const scene::Image cost = cost_picture(balance.cost, frame.size, balance.split);
    Frame of_volume = frame, of_cost = frame;
    const auto half = static_cast<std::ptrdiff_t>(frame.outputs.size() / 2);
    of_volume.outputs.erase(of_volume.outputs.begin() + half, of_volume.outputs.end());
    of_cost.outputs.erase(of_cost.outputs.begin(), of_cost.outputs.begin() + half);
    write_pictures(shown, rendered.deep, of_volume, options_);
    write_pictures(cost, rendered.deep, of_cost, options_);
  }

  /// On the writing rank, of a frame that has been written.
  void say(const Frame& frame, const RenderedFrame& rendered, FrameRecord record) {
    record.statistics = rendered.statistics;
    record.frame_ms = std::exchange(frame_ms_, {});
    if (options_.verify > 0) {
      const scene::TraceScope scope(writing(), "verify");
      record.verification = session_->verify(rendered, {record.camera, frame.size}, loaded_.function,
                                             static_cast<std::size_t>(options_.verify));
    }
    const auto at = static_cast<std::size_t>(&frame - frames_.data());
    skip_to(at);
    output_.add(options_, frame, record);
    next_ = at + 1;
  }

  void write_trace() {
    transport_.trace_to(nullptr, nullptr);
    io::TraceRun traced;
    std::string process = fmt::format("rank {}", transport_.rank());
    if (box_) traced = trace_run(options_, tets_, frames_.front(), output_.rendered());
    if (options_.is_volume) {
      traced.ranks = transport_.size();
      traced.rasterizer.clear();
      traced.integrator = method_word(options_.volume_settings.method);
    } else if (overlaps_) {
      traced = trace_run(options_, tets_, frames_.front(), output_.rendered());
      traced.ranks = transport_.size();
      traced.projectors = static_cast<int>(roles_.projectors.size());
      traced.compositors = static_cast<int>(roles_.compositors.size());
      traced.exchange = exchange_word(options_.exchange);
      const bool projects = roles_.projects(transport_.rank()), composites = roles_.composites(transport_.rank());
      process += projects && composites ? " projector + compositor" : projects ? " projector" : " compositor";
    }
    write_rank_traces(transport_, writer_, projecting_, process, traced, options_.timing);
  }

  const RenderOptions& options_;
  RenderOptions quiet_ = options_;
  exchange::Transport& transport_;
  const frame::Roles roles_;  ///< of a mesh
  const int writer_;
  const bool writes_, overlaps_;
  std::vector<Frame> frames_;
  scene::Trace projecting_, compositing_;
  RunOutput output_;

  const Settings settings_ = session_settings(options_);
  const ReadOptions read_ = read_options(options_);
  ReadOptions later_read_;  ///< of the steps after the first
  std::optional<Dataset> data_;
  std::optional<Session> session_;
  std::size_t step_ = 0;           ///< of data_
  std::optional<scene::Box> box_;  ///< of the first step; none until something is read
  std::uint64_t tets_ = 0;
  LoadedTransferFunction loaded_;

  std::size_t next_ = 0;           ///< frame that is to be reported
  std::vector<double> frame_ms_;   ///< of the frame at hand
  std::vector<std::size_t> jobs_;  ///< frame of each picture of the list at hand
  std::size_t jobs_before_ = 0;    ///< pictures of the lists before
};

}  // namespace

scene::ExitCode render(const RenderOptions& options, exchange::Transport& transport) {
  if (options.is_volume) refuse_mesh_options(options);
  return Film(options, transport).run();
}

}  // namespace tessera::apps
