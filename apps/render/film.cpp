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

#include "apps/options/series_choice.hpp"
#include "apps/options/setting_words.hpp"
#include "apps/render/empty_picture.hpp"
#include "apps/render/frame_annotation.hpp"
#include "apps/render/layer_pictures.hpp"
#include "apps/render/picture_queue.hpp"
#include "apps/render/picture_writer.hpp"
#include "apps/render/progress.hpp"
#include "apps/render/report.hpp"
#include "apps/render/run_output.hpp"
#include "apps/render/spare_images.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/image_file.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/session.hpp"
#include "tessera/statistics.hpp"
#include "tessera/trace.hpp"
#include "tessera/view.hpp"

namespace tessera::apps {
namespace {

/// Where the cost map of a picture goes: `a.png` gives `a.cost.png`.
std::filesystem::path cost_name(const std::filesystem::path& picture) {
  std::filesystem::path name = picture;
  return name.replace_extension().concat(".cost").concat(picture.extension().string());
}

/// With --show balance every picture has its cost map beside it; an annotation's layer is a frame's last picture.
std::vector<FilmFrame> frames_of(const RenderOptions& options) {
  FilmPlan plan = options.plan;
  if (!options.annotation.layer.empty()) plan.outputs.push_back(options.annotation.layer);
  std::vector<FilmFrame> frames = plan_film(plan);
  name_layers(options, frames);
  if (!options.show_balance) return frames;
  for (FilmFrame& frame : frames) {
    const std::size_t pictures = frame.outputs.size();
    for (std::size_t i = 0; i < pictures; ++i) {
      frame.outputs.push_back(cost_name(frame.outputs[i]));
      frame.finished = frame.finished && std::filesystem::exists(frame.outputs.back());
    }
  }
  return frames;
}

/// When the input's steps are, as one rank has found it.
std::vector<double> times_in(const RenderOptions& options, Job& job) {
  std::vector<double> times;
  if (job.rank() == 0) times = times_of(options.input(), options.read);
  const auto raw = std::as_bytes(std::span(times));
  const std::vector<std::byte> bytes = job.broadcast(0, {raw.begin(), raw.end()});
  times.resize(bytes.size() / sizeof(double));
  std::memcpy(times.data(), bytes.data(), bytes.size());
  return times;
}

/// One rank's part in a run. Of a time series one step is held at a time; the first gives the view.
class Film final : public Sink {
 public:
  Film(const RenderOptions& options, Job& job)
      : options_(options),
        job_(job),
        roles_(options.is_grid() ? Roles{}
                                 : assign_roles(job.size(), settings_.ranks.projectors, settings_.ranks.compositors)),
        writer_(options.is_grid() ? 0 : roles_.assembler()),
        writes_(job.rank() == writer_),
        overlaps_(!options.is_grid() && (job.size() > 1 || !settings_.mesh.device.backends.empty())),
        frames_(frames_of(options)),
        trace_(overlaps_ ? TraceRole::projector : TraceRole::both),
        compositing_(trace_, TraceRole::compositor),
        output_(quiet_ranks(options), frames_, job.size()) {
    settings_.trace = read_.trace = trace();
  }

  ExitCode run() {
    job_.require_same_files();  // which the plan goes by
    agree_on_finished_frames();
    for (std::size_t first = 0; first < frames_.size();) {
      // The frames of one step together: they share what is held.
      std::vector<std::size_t> group;
      std::size_t last = first;
      for (; last < frames_.size() && frames_[last].step == frames_[first].step; ++last)
        if (!frames_[last].finished) group.push_back(last);
      if (!group.empty()) {
        hold(frames_[group.front()]);
        overlaps_ || grids_overlap(group) ? make_overlapping(group) : make_one_by_one(group);
      }
      first = last;
    }
    if (writes_) pictures_.add([this] { picture_writer_.finish(); });
    pictures_.finish();
    skip_to(frames_.size());
    warn_of_range();
    warn_of_empty();
    if (timed()) write_trace();
    std::vector<std::byte> code(1);
    if (writes_) code[0] = static_cast<std::byte>(output_.finish(options_));
    return static_cast<ExitCode>(job_.broadcast(writer_, code)[0]);
  }

  [[nodiscard]] bool wants_tiles() const override { return false; }

  /// Of frames that overlap, on the writing rank: every repetition of every frame in order.
  void frame(RenderedFrame&& rendered) override {
    if (!writes_) return;
    const std::size_t at = jobs_[rendered.number];
    frame_ms_.push_back(rendered.statistics.milliseconds);
    if (rendered.number + 1 < jobs_.size() && jobs_[rendered.number + 1] == at)
      return spare_images_.keep(std::move(rendered.image));
    const FilmFrame& frame = frames_[at];
    FrameRecord record;
    record.camera = camera_of(frame);
    const auto number = static_cast<std::int32_t>(jobs_before_ + rendered.number);
    // Written and forgotten, its memory is a later picture's.
    const std::shared_ptr<const RenderedFrame> picture(new RenderedFrame(std::move(rendered)),
                                                       [this](RenderedFrame* written) {
                                                         spare_images_.keep(std::move(written->image));
                                                         delete written;
                                                       });
    pictures_.add([this, picture, annotated = annotated_frame(frame, record.camera), number] {
      const TraceScope scope(writing(), "write", number);
      write_annotated(picture->image, picture->deep, annotated, picture_writer_);
      write_layers(*picture, annotated.frame, options_);
    });
    say(frame, *picture, std::move(record));
  }

  Image spare_image(ImageSize size) override { return spare_images_.take(size); }

 private:
  [[nodiscard]] bool timed() const { return !options_.timing.empty(); }
  [[nodiscard]] Trace* trace() { return timed() ? &trace_ : nullptr; }
  /// Where the writing rank's own work goes.
  [[nodiscard]] Trace* writing() { return !timed() ? nullptr : overlaps_ ? &compositing_ : &trace_; }

  /// Only one rank shows progress.
  const RenderOptions& quiet_ranks(const RenderOptions& options) {
    quiet_.progress = options.progress && writes_;
    return quiet_;
  }

  /// The writing rank's view of the disk holds for all.
  void agree_on_finished_frames() {
    if (writes_) {
      check_annotation(options_.annotation);
      PictureWriter::check(options_, frames_);
      const std::array inputs = {options_.input(), options_.plan.cameras, options_.read.plot3d_q,
                                 std::filesystem::path(options_.transfer_function)};
      check_film_outputs(frames_, other_outputs(), inputs);
    }
    std::vector<std::byte> finished(frames_.size());
    for (std::size_t i = 0; i < frames_.size(); ++i) finished[i] = std::byte{frames_[i].finished};
    finished = job_.broadcast(writer_, std::move(finished));
    for (std::size_t i = 0; i < frames_.size(); ++i) frames_[i].finished = finished[i] != std::byte{0};
  }

  /// Outputs other than the frames' pictures. Paths of those that were not asked for are empty.
  [[nodiscard]] std::vector<std::filesystem::path> other_outputs() const {
    std::vector<std::filesystem::path> outputs = options_.films;
    outputs.insert(outputs.end(), {options_.timing, options_.saved_scene});
    if (!options_.report_to_standard_output) outputs.push_back(options_.report);
    return outputs;
  }

  /// What the input's files name is known once they are read. Every rank asks: each has read its own part.
  void check_outputs_are_no_inputs() const {
    for (const FilmFrame& frame : frames_)
      for (const auto& output : frame.outputs) check_not_read(output);
    for (const auto& output : other_outputs())
      if (!output.empty()) check_not_read(output);
  }

  void skip_to(std::size_t frame) {
    for (; writes_ && next_ < frame; ++next_) output_.skip(options_, frames_[next_]);
  }

  [[nodiscard]] std::string rendering_words(const FilmFrame& frame) const {
    return frames_.size() > 1 ? "rendering the next"
                              : fmt::format("rendering {}x{}", frame.size.width, frame.size.height);
  }

  [[nodiscard]] Camera camera_of(const FilmFrame& frame) const {
    return frame.view(*box_, options_.projection, options_.view, axes_);
  }

  void open(const FilmFrame& frame, const ReadOptions& read) {
    frame.require_still_there();
    session_.reset();  // the last step's memory before the next one's
    data_.reset();
    output_.line().begin("reading " + frame.data.files.front().filename().string());
    ReadOptions watched = read;
    if (frame.data.in_file) watched.time_step = frame.data.in_file;
    watched.progress = output_.line().listener();
    data_.emplace(Dataset::open(frame.data.files, watched, job_.communicator(), settings_.ranks));
    step_ = frame.step;
    if (shows_shape_ && !data_->shows_shape())
      throw bad_input(
          fmt::format("{}: time step {} shows the field '{}', which no step varies in that the choice went "
                      "by, and those before show the shape; choose it with --field, or steps with "
                      "--time-step FIRST:LAST",
                      frame.data.files.front().string(), step_, data_->field_name()));
    if (const auto time = data_->time(); time && !frame.data.has_time)
      for (FilmFrame& each : frames_)
        if (each.step == step_) each.data.time = *time, each.data.has_time = true;
    read_block_surfaces(frame.data.files, watched);
    const auto [low, high] = data_->range();
    if (!first_range_) all_range_ = first_range_.emplace(std::array{low, high});
    all_range_ = {std::min(all_range_[0], low), std::max(all_range_[1], high)};
  }

  /// Of the step at hand, with its field.
  void read_block_surfaces(const std::vector<std::filesystem::path>& files, ReadOptions read) {
    if (options_.block_surfaces.empty() && data_->axis_scale() == glm::dvec3(1)) return;
    options_.block_surfaces = found_blocks(options_.block_surfaces, *data_);
    if (writes_) output_.note("method", method_json(options_, job_.size()));
    settings_.surfaces =
        with_block_surfaces(options_.settings.surfaces, options_.block_surfaces, *data_, files, std::move(read));
  }

  /// Field and colors of several steps, where options do not say them. Leaves the first one open.
  void choose_for_all_steps() {
    const std::size_t count = frames_.back().step + 1;
    const auto first_of = [&](std::size_t step) -> const FilmFrame& {
      return *std::ranges::find(frames_, step, &FilmFrame::step);
    };
    // The writing rank's view of the disk holds for all.
    std::vector<std::size_t> steps = steps_to_look_at(count);
    std::vector<std::byte> there;
    there.reserve(steps.size());
    for (const std::size_t step : steps) there.push_back(std::byte{first_of(step).is_there()});
    there = job_.broadcast(writer_, std::move(there));
    for (std::size_t k = steps.size(); k-- > 1;)
      if (there[k] == std::byte{0}) {
        if (writes_)
          output_.warn(options_,
                       fmt::format("time step {} is not there any more: field and colors go by others", steps[k]));
        steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(k));
      }
    const OpenStep open_step = [&](std::size_t step, const ReadOptions& read) -> const Dataset* {
      try {
        open(first_of(step), read);
      } catch (const Error&) {
        if (step == 0 || job_.size() > 1) throw;
        return nullptr;
      }
      return &*data_;
    };
    series_ = choose_by_steps(std::move(steps), options_, read_, open_step);
    read_.field = series_->field;
    first_range_ = all_range_ = series_->range;
    if (series_->function) loaded_ = *series_->function;
  }

  /// Colours and opacities are of some steps, of whose values the others' may be far.
  void warn_of_range() {
    if (!writes_ || !first_range_ || options_.function.range || function_has_values(options_)) return;
    const auto [low, high] = *first_range_;
    const double beyond = std::max(low - all_range_[0], all_range_[1] - high);
    if (beyond > 0.1 * (high - low))
      output_.warn(options_, fmt::format("values of all time steps are from {:.6g} to {:.6g}, colours go by those of "
                                         "{:.6g} to {:.6g}; --range {:.6g},{:.6g} spans all",
                                         all_range_[0], all_range_[1], low, high, all_range_[0], all_range_[1]));
  }

  /// Of pictures that show nothing. What may show something is tried on all ranks, with the step that they hold.
  void warn_of_empty() {
    if (!box_) return;
    const std::string warning =
        empty_.warning({job_, writer_, frames_, step_, options_, *data_, loaded_.function, *box_, axes_});
    if (writes_ && !warning.empty()) output_.warn(options_, warning);
  }

  /// Higher-order cells as finely as --accuracy needs. What is right for the first picture is taken for all.
  void come_near_enough() {
    if (data_->higher_order_cells().divided == 0) return;
    const HigherOrderRead near = read_for_accuracy(
        read_, options_.higher_order_accuracy,
        [this, is_open = true](const ReadOptions& read) mutable {
          if (!std::exchange(is_open, false) || read.higher_order_tolerance != read_.higher_order_tolerance)
            open(frames_.front(), read);
          return *data_;
        },
        [this](const Dataset&) {
          find_function();
          return loaded_.function;
        },
        [this](const Dataset& data) {
          const FilmFrame& frame = frames_.front();
          return View{frame.view(data.bounds(), options_.projection, options_.view, data.body_axes()), frame.size};
        },
        settings_, job_.communicator());
    data_ = near.dataset;
    find_function();
    read_ = near.options;
    higher_order_pixels_ = near.pixel_error;
  }

  void find_function() {
    if (!series_ || !series_->function) loaded_ = transfer_function_of(*data_, options_);
  }

  /// What the default transfer function means to be shaded is so, unless an option of the run speaks against it.
  void shade_by_default() {
    if (!shades_by_default(loaded_, options_)) return;
    settings_.grid.shading.emplace();
    options_.settings.grid.shading = settings_.grid.shading;
    if (writes_) output_.note("method", method_json(options_, job_.size()));
  }

  /// Of the data at hand, with what its higher-order cells do to pixels.
  [[nodiscard]] analysis::Description description() const {
    analysis::Description data = described(*data_);
    if (series_) data.notes.push_back(series_note(*series_, frames_.back().step + 1, data_->field_name()));
    if (data_->higher_order_cells().divided == 0) return data;
    data.higher_order_pixels = higher_order_pixels_;
    // Of cells drawn by their corners there is a warning already.
    if (data.higher_order.by_corners > 0) return data;
    const double error = higher_order_pixels_, accuracy = options_.higher_order_accuracy.value_or(error);
    (error > accuracy ? data.warnings : data.notes).push_back(higher_order_note(error, accuracy));
    return data;
  }

  /// Makes the frame's step the one at hand.
  void hold(const FilmFrame& frame) {
    if (!box_) {
      if (goes_by_steps(frames_.back().step + 1, options_))
        choose_for_all_steps();
      else
        open(frames_.front(), read_);
      find_function();
      check_outputs_are_no_inputs();
      job_.require_same_files();  // the transfer function's
      come_near_enough();
      shade_by_default();
      if (writes_) check_annotation(options_.annotation, frame, *data_, loaded_.function);
      shows_shape_ = data_->shows_shape();
      box_ = data_->bounds();
      axes_ = data_->body_axes();
      tets_ = data_->tet_count();
      later_read_ = read_of_later_steps(read_, *data_);
      if (writes_) output_.describe(options_, description(), loaded_);
      if (writes_ && overlaps_) output_.note("job", job_json(options_, job_.size(), roles_));
    }
    if (frame.step != step_) open(frame, later_read_);
    if (session_) return;
    output_.line().begin("preparing " + frame.data.files.front().filename().string());
    session_.emplace(*data_, settings_, job_.communicator());
  }

  /// Of several pictures of a volume one is cast while the one before is gathered.
  [[nodiscard]] bool grids_overlap(const std::vector<std::size_t>& group) const {
    const FrameSettings& frame = options_.frame;
    return options_.is_grid() && job_.size() > 1 && group.size() > 1 && !frame.deep && !frame.peel && !frame.keep_cost;
  }

  void make_one_by_one(const std::vector<std::size_t>& group) {
    for (const std::size_t at : group) {
      const FilmFrame& frame = frames_[at];
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
        output_.line().begin(rendering_words(frame));
        FrameProgress progress(output_.line(), frame.size);
        rendered = session_->render({record.camera, frame.size}, loaded_.function, options_.frame,
                                    output_.line().shown() ? &progress : nullptr);
        frame_ms_.push_back(rendered.statistics.milliseconds);
      }
      if (!writes_) {
        if (trace() != nullptr) trace()->add_frame(frame.number, frame_begin);
        continue;
      }
      if (!frame.outputs.empty()) output_.line().begin("writing " + frame.outputs.front().filename().string());
      const auto picture = std::make_shared<const RenderedFrame>(std::move(rendered));
      // The cost map is the session's to draw, and that is at the next frame by the time a thread behind would ask.
      std::optional<BalancePictures> shown;
      if (options_.show_balance)
        shown = session_->balance_pictures(*picture, {record.camera, frame.size}, loaded_.function);
      pictures_.add([this, picture, shown = std::move(shown), &frame, annotated = annotated_frame(frame, record.camera),
                     frame_begin] {
        {
          const TraceScope scope(trace(), "write", frame.number);
          shown ? write_balance(*shown, picture->deep, frame)
                : write_annotated(picture->image, picture->deep, annotated, picture_writer_);
          write_layers(*picture, frame, options_);
        }
        if (trace() != nullptr) trace()->add_frame(frame.number, frame_begin);
      });
      say(frame, *picture, std::move(record));
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
    output_.line().begin(rendering_words(frames_[group.front()]));
    if (options_.is_grid() && trace() != nullptr) trace()->set_frame(static_cast<std::int32_t>(jobs_before_));
    session_->render(views, loaded_.function, options_.frame, *this);
    jobs_before_ += jobs_.size();
  }

  /// With what its annotation tells of, which may be another step's by the time the picture is written.
  [[nodiscard]] AnnotatedFrame annotated_frame(const FilmFrame& frame, const Camera& camera) const {
    return {frame, camera, *data_, loaded_.function, options_};
  }

  /// The first half of the frame's outputs shows the bricks, the second what they cost.
  void write_balance(const BalancePictures& shown, const DeepImage& deep, const FilmFrame& frame) {
    FilmFrame of_volume = frame, of_cost = frame;
    const auto half = static_cast<std::ptrdiff_t>(frame.outputs.size() / 2);
    of_volume.outputs.erase(of_volume.outputs.begin() + half, of_volume.outputs.end());
    of_cost.outputs.erase(of_cost.outputs.begin(), of_cost.outputs.begin() + half);
    picture_writer_.write(shown.bricks, deep, of_volume);
    // Films and standard output show the volume.
    for (const auto& output : of_cost.outputs) write_image(shown.cost, output, options_.image);
  }

  /// Pictures of a film are written behind it, but for those so large that memory should not hold two. One thread
  /// compresses a PNG in the time in which some ten make the picture; films and annotations are made in order.
  [[nodiscard]] int writers() const {
    constexpr std::int64_t most_pixels = 4096 * 4096;
    constexpr int makers_a_writer = 8;
    std::size_t left = 0;
    std::int64_t pixels = 1;
    for (const FilmFrame& frame : frames_)
      if (!frame.finished) {
        ++left;
        pixels = std::max(pixels, std::int64_t{frame.size.width} * frame.size.height);
      }
    if (!writes_ || left < 2 || pixels > most_pixels) return 0;
    if (options_.annotation.annotation || !options_.films.empty() || options_.to_standard_output) return 1;
    const auto wanted = std::min<std::int64_t>(threads_for(settings_.threads) / makers_a_writer, most_pixels / pixels);
    return static_cast<int>(std::max<std::int64_t>(wanted, 1));
  }

  /// On the writing rank, of a frame that is written, or will be before the run ends without an error.
  void say(const FilmFrame& frame, const RenderedFrame& rendered, FrameRecord record) {
    record.statistics = rendered.statistics;
    record.frame_ms = std::exchange(frame_ms_, {});
    if (options_.verify > 0) {
      const TraceScope scope(writing(), "verify");
      output_.line().begin(fmt::format("verifying {} pixels", options_.verify));
      record.verification = session_->verify(rendered, {record.camera, frame.size}, loaded_.function,
                                             static_cast<std::size_t>(options_.verify));
    }
    const auto at = static_cast<std::size_t>(&frame - frames_.data());
    empty_.look_at(at, rendered, *data_, loaded_.function, options_);
    skip_to(at);
    output_.add(options_, frame, record);
    next_ = at + 1;
  }

  void write_trace() {
    session_.reset();  // its spans end before they are written
    TraceRun traced;
    std::string process = fmt::format("rank {}", job_.rank());
    if (box_) traced = trace_run(options_, tets_, frames_.front(), output_.rendered());
    if (options_.is_grid()) {
      traced.ranks = job_.size();
      traced.integrator = method_word(settings_.integrator.kind);
    } else if (overlaps_) {
      traced = trace_run(options_, tets_, frames_.front(), output_.rendered());
      traced.ranks = job_.size();
      traced.projectors = static_cast<int>(roles_.projectors.size());
      traced.compositors = static_cast<int>(roles_.compositors.size());
      traced.exchange = exchange_word(exchange_of(settings_, options_.frame.deep || options_.frame.peel));
      const bool projects = roles_.projects(job_.rank()), composites = roles_.composites(job_.rank());
      process += projects && composites ? " projector + compositor" : projects ? " projector" : " compositor";
    }
    tessera::write_trace(trace_, process, traced, options_.timing, job_.communicator(), writer_);
  }

  RenderOptions options_;  ///< with what is chosen once the data is known
  RenderOptions quiet_ = options_;
  Job& job_;
  Settings settings_ = options_.settings;
  ReadOptions read_ = options_.read;
  const Roles roles_;  ///< of a mesh
  const int writer_;
  const bool writes_, overlaps_;
  std::vector<FilmFrame> frames_;
  Trace trace_, compositing_;
  RunOutput output_;

  bool shows_shape_ = false;        ///< the first step
  ReadOptions later_read_;          ///< of the steps after the first
  double higher_order_pixels_ = 0;  ///< HigherOrderRead::pixel_error of the first step
  std::optional<Dataset> data_;
  std::optional<Session> session_;
  std::size_t step_ = 0;                              ///< of data_
  std::optional<std::array<double, 2>> first_range_;  ///< of the values that colors go by
  std::array<double, 2> all_range_{};                 ///< of all steps read
  std::optional<Box> box_;                            ///< of the first step; none until something is read
  BodyAxes axes_ = BodyAxes::none;
  EmptyPictures empty_;
  std::uint64_t tets_ = 0;
  LoadedTransferFunction loaded_;
  std::optional<SeriesChoice> series_;  ///< of several steps

  std::size_t next_ = 0;           ///< frame that is to be reported
  std::vector<double> frame_ms_;   ///< of the frame at hand
  std::vector<std::size_t> jobs_;  ///< frame of each picture of the list at hand
  std::size_t jobs_before_ = 0;    ///< pictures of the lists before

  PictureWriter picture_writer_{options_};
  SpareImages spare_images_;
  PictureQueue pictures_{writers()};  ///< last: what it writes refers to all above
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
