// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/program/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "cells/field_choice.hpp"
#include "system/free_memory.hpp"
#include "tessera/error.hpp"
#include "tessera/image_file.hpp"
#include "tessera/input_file.hpp"
#include "tessera/program/output_file.hpp"
#include "tessera/view.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

constexpr std::size_t max_frames = 10'000'000;

/// Throws if the image does not fit in memory. Otherwise the kernel would kill the process without a message.
void check_fits_memory(ImageSize size) {
  constexpr double bytes_a_pixel = 22;  // four floats, a depth and buffers; measured at 4000 x 4000 and 8000 x 8000
  const double needed = bytes_a_pixel * size.width * size.height;
  if (needed < (64 << 20)) return;
  const auto free = static_cast<double>(system::available_memory());
  if (needed > free)
    throw Error(
        ErrorCode::system_failure,
        fmt::format("`size`: a {}x{} image takes {:.1f} GiB, but only {:.1f} GiB are free; make the image smaller",
                    size.width, size.height, needed / (1 << 30), free / (1 << 30)));
}

std::vector<FilmFrame> views(const FilmPlan& plan) {
  std::vector<FilmFrame> frames;
  if (plan.cameras.empty()) {
    FilmFrame frame;
    frame.size = plan.size.value_or(ImageSize{});
    frames.push_back(frame);
  } else {
    for (const auto& view : cameras_of(plan.cameras.string())) {
      FilmFrame frame;
      frame.camera = view.camera;
      frame.size = plan.size.value_or(view.size.value_or(ImageSize{}));
      frames.push_back(frame);
    }
  }
  if (plan.orbit > 0) {
    if (frames.size() != 1)
      throw bad_input(fmt::format("{}: `orbit` needs exactly one view, but this file has {}; give one",
                                  is_json_text(plan.cameras.string()) ? "`camera`" : plan.cameras.string(),
                                  frames.size()));
    const FilmFrame first = frames.front();
    frames.assign(static_cast<std::size_t>(plan.orbit), first);
    for (std::size_t i = 0; i < frames.size(); ++i)
      frames[i].turn = static_cast<double>(i) / static_cast<double>(frames.size());
  }
  return frames;
}

/// Returns the existing steps of the plan's range.
std::vector<TimeStep> in_range(std::vector<TimeStep> steps, const FilmPlan& plan) {
  if (!plan.steps) return steps;
  const auto [first, last_wished, stride] = *plan.steps;
  const std::size_t last = last_wished.value_or(steps.size() - 1);
  if (std::max(first, last) >= steps.size())
    throw bad_input(fmt::format("{}: there is no time step {}, it has only {}; count from 0",
                                plan.inputs.front().string(), std::max(first, last), steps.size()));
  std::vector<TimeStep> chosen;
  for (std::size_t step = first; step <= last; step += std::max<std::size_t>(stride, 1))
    chosen.push_back(std::move(steps[step]));
  return chosen;
}

std::vector<TimeStep> steps_of_file(const FilmPlan& plan) {
  std::vector<TimeStep> steps;
  for (std::size_t step = 0; step < std::max<std::size_t>(plan.file_steps, 1); ++step) {
    const bool timed = step < plan.file_times.size();
    steps.push_back({timed ? plan.file_times[step] : static_cast<double>(step), plan.inputs, step, timed});
  }
  return steps;
}

std::vector<TimeStep> steps(const FilmPlan& plan) {
  if (plan.inputs.empty()) throw bad_input("input: no file was given; give one");
  if (takes_steps_of_file(plan)) return steps_of_file(plan);
  if (!plan.series.empty()) return plan.series;
  std::vector<TimeStep> steps;
  for (const auto& input : plan.inputs) steps.push_back({static_cast<double>(steps.size()), {input}});
  for (const auto& step : steps)
    if (steps.size() > 1 && is_time_series(step.files.front()))
      throw bad_input(fmt::format("{}: it is a time series in a list of meshes; give it alone, or give only meshes",
                                  step.files.front().string()));
  return steps;
}

}  // namespace

bool is_series(const FilmPlan& plan) {
  return plan.inputs.size() > 1 || !plan.series.empty() || takes_steps_of_file(plan);
}

bool takes_steps_of_file(const FilmPlan& plan) { return plan.steps && plan.inputs.size() == 1 && plan.series.empty(); }

std::vector<FilmFrame> plan_film(const FilmPlan& plan) {
  const auto views_of_each = views(plan);
  std::vector<FilmFrame> frames;
  const auto series = in_range(steps(plan), plan);
  if (series.size() * views_of_each.size() > max_frames)
    throw bad_input(fmt::format("{}: {} time steps of {} views are more than {} frames; render them in parts",
                                plan.inputs.front().string(), series.size(), views_of_each.size(), max_frames));
  for (std::size_t step = 0; step < series.size(); ++step)
    for (FilmFrame frame : views_of_each) {
      frame.number = static_cast<int>(frames.size());
      frame.step = step;
      frame.data = series[step];
      frames.push_back(std::move(frame));
    }
  for (const auto& output : plan.outputs)
    for (auto& frame : frames) {
      const auto numbered = numbered_name(output.string(), frame.number);
      frame.outputs.emplace_back(numbered.value_or(output.string()));
      if (!numbered && frames.size() > 1)
        throw bad_input(fmt::format("{}: the names of {} frames need numbers; write {}_%04d{}", output.string(),
                                    frames.size(), (output.parent_path() / output.stem()).string(),
                                    output.extension().string()));
    }
  if (plan.resume)
    for (auto& frame : frames)
      frame.finished = std::all_of(frame.outputs.begin(), frame.outputs.end(), [](const auto& output) {
        std::error_code ignored;  // a frame in an unreadable directory is not finished; the check of outputs reports
                                  // the reason
        return std::filesystem::is_regular_file(output, ignored) && std::filesystem::file_size(output, ignored) > 0;
      });
  // Checks all files now, so that a film does not fail at its last step because a file is missing. The kind of data
  // (plan.grids) was determined from the first step.
  if (is_series(plan))
    for (const auto& frame : frames)
      if (!frame.finished)
        for (const auto& file : frame.data.files) plan.grids ? require_grid(file) : require_mesh(file);
  return frames;
}

Camera FilmFrame::view(const Box& box, ProjectionKind default_projection, const ViewRequest& request,
                       BodyAxes axes) const {
  const Camera seen = camera ? adjusted_view(*camera, box, size, request)
                             : view_of_box(box, size, request, default_projection, axes, turn.has_value());
  return turn ? tessera::orbit(seen, *turn) : seen;
}

bool FilmFrame::is_there() const {
  return std::ranges::all_of(data.files, [](const std::filesystem::path& file) {
    std::error_code unreadable;
    return std::filesystem::exists(file, unreadable);
  });
}

void FilmFrame::require_still_there() const {
  if (step == 0) return;
  for (const auto& file : data.files) {
    std::error_code unreadable;  // for an unreadable file, reading reports the reason
    if (!std::filesystem::exists(file, unreadable) && !unreadable)
      throw Error(ErrorCode::system_failure,
                  fmt::format("{}: it existed when the run began, but no longer does; restore it and use `resume`",
                              file.string()));
  }
}

std::string field_of_steps(std::span<const std::vector<FieldInfo>> steps, const ReadOptions& options) {
  if (steps.empty()) return "";
  const auto is_same = [](const FieldInfo& a, const FieldInfo& b) {
    return a.name == b.name && a.association == b.association && a.components == b.components;
  };
  std::vector<FieldInfo> widest;
  for (const FieldInfo& first : steps.front()) {
    FieldInfo field = first;
    // A field that varies in only one step is a quantity, too, for example an initial ramp.
    bool is_quantity = false;
    const bool everywhere = std::ranges::all_of(steps, [&](const std::vector<FieldInfo>& step) {
      const auto found = std::ranges::find_if(step, [&](const FieldInfo& f) { return is_same(f, field); });
      if (found == step.end()) return false;
      if (found->high - found->low > field.high - field.low) field.low = found->low, field.high = found->high;
      field.ids = field.ids || found->ids;
      field.fractions = field.fractions || found->fractions;
      is_quantity = is_quantity || (found->high > found->low && !found->ids);
      return true;
    });
    field.ids = field.ids && !is_quantity;
    if (everywhere) widest.push_back(std::move(field));
  }
  const cells::FieldChoice choice = cells::choose_field("", widest, "series", true);
  if (choice.name.empty()) return "";
  if (options.smooth) return choice.label;
  return (choice.association == Association::point ? "point:" : "cell:") + choice.label;
}

ReadOptions read_of_later_steps(ReadOptions options, const Dataset& first) {
  options.axis_scale = first.axis_scale();
  if ((first.is_grid() && first.fields().size() < 2) || !options.field.empty() || first.fields().empty() ||
      first.shows_shape())
    return options;
  options.field = first.field_name();
  // After smoothing, the data are point data even if the file has cell data, so the prefix is not known.
  if (!options.smooth) options.field = (first.association() == Association::point ? "point:" : "cell:") + options.field;
  return options;
}

void check_film_outputs(std::span<const FilmFrame> frames, std::span<const std::filesystem::path> more,
                        std::span<const std::filesystem::path> inputs) {
  std::set<std::filesystem::path> names;
  std::map<std::filesystem::path, std::filesystem::path> real_folders;
  const auto check_new = [&](const std::filesystem::path& output) {
    auto [folder, is_new] = real_folders.try_emplace(output.parent_path());
    std::error_code unknown;
    if (is_new)
      folder->second = std::filesystem::weakly_canonical(std::filesystem::absolute(output).parent_path(), unknown);
    if (!names.insert(folder->second / output.filename()).second)
      throw bad_input(fmt::format("{}: it is given twice as an output; choose two names", output.string()));
    for (const auto& input : inputs) check_not_input(output, input);
  };

  std::set<std::filesystem::path> folders;
  for (const FilmFrame& frame : frames) {
    validate(frame.size);
    check_fits_memory(frame.size);
    for (const auto& output : frame.outputs) {
      check_new(output);
      for (const auto& file : frame.data.files) check_not_input(output, file);
      if (frame.finished) continue;
      // The file system is queried once per directory and length of name; every existing name needs a separate query.
      std::error_code unknown;
      const std::string kind = fmt::format("{}{}", output.filename().native().size(), output.extension().string());
      if (folders.insert(output.parent_path() / kind).second || std::filesystem::exists(output, unknown) || unknown)
        check_image_path(output);
    }
  }
  for (const auto& output : more)
    if (!output.empty()) {
      check_new(output);
      check_writable(output);
    }
}

}  // namespace v0_1
}  // namespace tessera
