// SPDX-License-Identifier: BSD-3-Clause
#include "apps/render/shown_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

#include "apps/render/frame_annotation.hpp"
#include "apps/render/planned_frames.hpp"
#include "apps/render/report.hpp"
#include "tessera/error.hpp"
#include "tessera/higher_order.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/view.hpp"

namespace tessera::apps {

ShownStep::ShownStep(RenderOptions& options, std::vector<FilmFrame>& frames, RunOutput& output, Job& job,
                     int writing_rank, Trace* trace)
    : options_(options),
      frames_(frames),
      output_(output),
      job_(job),
      writing_rank_(writing_rank),
      settings_(options.settings),
      read_(options.read) {
  settings_.trace = read_.trace = trace;
}

void ShownStep::show(const FilmFrame& frame) {
  if (!first_) open_first();
  if (frame.step != step_) open(frame, first_->later_read);
  if (session_) return;
  output_.line().begin("preparing " + frame.data.files.front().filename().string());
  session_.emplace(*data_, settings_, job_.communicator());
}

void ShownStep::open_first() {
  if (depends_on_steps(steps(), options_))
    choose_for_all_steps();
  else
    open(frames_.front(), read_);
  find_function();
  check_outputs_are_not_read();
  job_.require_same_files();  // including the file of the transfer function
  read_within_accuracy();
  shade_by_default();
  if (job_.rank() == writing_rank_) check_annotation(options_.annotation, frames_.front(), *data_, loaded_.function);
  first_.emplace(First{.box = data_->bounds(),
                       .axes = data_->body_axes(),
                       .shows_shape = data_->shows_shape(),
                       .tets = data_->tet_count(),
                       .later_read = read_of_later_steps(read_, *data_)});
  output_.describe(description(), loaded_);
}

void ShownStep::open(const FilmFrame& frame, const ReadOptions& read) {
  frame.require_still_there();
  session_.reset();  // free the last step's memory before the next one
  data_.reset();
  const std::filesystem::path& file = frame.data.files.front();
  output_.line().begin("reading " + file.filename().string());
  ReadOptions watched = read;
  if (frame.data.in_file) watched.time_step = frame.data.in_file;
  watched.progress = output_.line().listener();
  data_.emplace(options_.open(frame.data.files, watched, job_.communicator()));
  step_ = frame.step;
  if (first_ && first_->shows_shape && !data_->shows_shape())
    throw bad_input(fmt::format(
        "{}: time step {} shows the field '{}', but earlier steps show the shape, because this field is constant in "
        "the steps examined first; choose the field with --field, or steps with --time-step FIRST:LAST",
        file.string(), step_, data_->field_name()));
  if (const auto time = data_->time(); time && !frame.data.has_time)
    for (FilmFrame& each : frames_)
      if (each.step == step_) each.data.time = *time, each.data.has_time = true;
  read_block_surfaces(frame.data.files, watched);
  const auto [low, high] = data_->range();
  if (!colored_range_) whole_range_ = colored_range_.emplace(Range{low, high});
  whole_range_ = {std::min(whole_range_[0], low), std::max(whole_range_[1], high)};
}

/// Reads the surfaces of blocks, with the field of this step.
void ShownStep::read_block_surfaces(const std::vector<std::filesystem::path>& files, ReadOptions read) {
  if (options_.block_surfaces.empty() && data_->axis_scale() == glm::dvec3(1)) return;
  options_.block_surfaces = found_blocks(options_.block_surfaces, *data_);
  note_method();
  settings_.surfaces =
      with_block_surfaces(options_.settings.surfaces, options_.block_surfaces, *data_, files, std::move(read));
}

/// Chooses field and colours for several steps if options do not specify them. Leaves the first step open.
void ShownStep::choose_for_all_steps() {
  const auto frame_of = [&](std::size_t step) -> const FilmFrame& {
    return *std::ranges::find(frames_, step, &FilmFrame::step);
  };
  // All ranks use the list of existing steps that the writing rank finds on its disk.
  std::vector<std::size_t> steps = steps_to_examine(this->steps());
  std::vector<std::byte> there;
  there.reserve(steps.size());
  for (const std::size_t step : steps) there.push_back(std::byte{frame_of(step).is_there()});
  there = job_.broadcast(writing_rank_, std::move(there));
  for (std::size_t k = steps.size(); k-- > 1;)
    if (there[k] == std::byte{0}) {
      output_.warn(
          fmt::format("time step {} no longer exists: field and colours are chosen from other steps", steps[k]));
      steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(k));
    }
  const OpenStep open_step = [&](std::size_t step, const ReadOptions& read) -> const Dataset* {
    try {
      open(frame_of(step), read);
    } catch (const Error&) {
      if (step == 0 || job_.size() > 1) throw;
      return nullptr;
    }
    return &*data_;
  };
  series_ = choose_by_steps(std::move(steps), options_, read_, open_step);
  read_.field = series_->field;
  colored_range_ = whole_range_ = series_->range;
  if (series_->function) loaded_ = *series_->function;
}

/// Divides higher-order cells as finely as --accuracy requires. The tolerance found for the first image is used for all
/// images.
void ShownStep::read_within_accuracy() {
  if (data_->higher_order_cells().divided == 0) return;
  const FilmFrame& frame = frames_.front();
  const HigherOrderRead near = read_for_accuracy(
      read_, options_.higher_order_accuracy,
      [&, is_open = true](const ReadOptions& read) mutable {
        if (!std::exchange(is_open, false) || read.higher_order_tolerance != read_.higher_order_tolerance)
          open(frame, read);
        return *data_;
      },
      [&](const Dataset&) {
        find_function();
        return loaded_.function;
      },
      [&](const Dataset& data) {
        return View{frame.view(data.bounds(), options_.projection, options_.view, data.body_axes()), frame.size};
      },
      settings_, job_.communicator());
  data_ = near.dataset;
  find_function();
  read_ = near.options;
  higher_order_pixels_ = near.pixel_error;
}

void ShownStep::find_function() {
  if (!series_ || !series_->function) loaded_ = transfer_function_of(*data_, options_);
}

void ShownStep::shade_by_default() {
  if (!shades_by_default(loaded_, options_)) return;
  settings_.grid.shading.emplace();
  options_.settings.grid.shading = settings_.grid.shading;
  note_method();
}

void ShownStep::note_method() { output_.note("method", method_json(options_, job_.size())); }

/// Throws if an output is a file that has been read. This check follows the reading, because the input's files may
/// refer to further files. Every rank checks, because each rank has read its own part.
void ShownStep::check_outputs_are_not_read() const {
  for (const FilmFrame& frame : frames_)
    for (const auto& output : frame.outputs) check_not_read(output);
  for (const auto& output : other_outputs(options_))
    if (!output.empty()) check_not_read(output);
}

analysis::Description ShownStep::description() const {
  analysis::Description data = described(*data_);
  if (series_) data.notes.push_back(series_note(*series_, steps(), data_->field_name()));
  if (data_->higher_order_cells().divided == 0) return data;
  data.higher_order_pixels = higher_order_pixels_;
  // Another warning already reports cells that are drawn by their corners.
  if (data.higher_order.by_corners > 0) return data;
  const double error = higher_order_pixels_, accuracy = options_.higher_order_accuracy.value_or(error);
  (error > accuracy ? data.warnings : data.notes).push_back(higher_order_note(error, accuracy));
  return data;
}

void ShownStep::warn_at_end(const EmptyPictures& empty) const {
  if (!first_) return;
  if (!options_.function.range && !function_has_values(options_)) {
    const auto [low, high] = *colored_range_;
    const auto [lowest, highest] = whole_range_;
    if (std::max(low - lowest, highest - high) > 0.1 * (high - low))
      output_.warn(
          fmt::format("the values of all time steps range from {:.6g} to {:.6g}, but the colours span {:.6g} to "
                      "{:.6g}; --range {:.6g},{:.6g} spans all",
                      lowest, highest, low, high, lowest, highest));
  }
  const std::string warning = empty.warning(
      {job_, writing_rank_, frames_, step_, options_, *data_, loaded_.function, first_->box, first_->axes});
  if (!warning.empty()) output_.warn(warning);
}

}  // namespace tessera::apps
