// SPDX-License-Identifier: BSD-3-Clause
#include "apps/commands/info_command.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "apps/options/series_choice.hpp"
#include "apps/render/progress.hpp"
#include "apps/render/report.hpp"
#include "tessera/error.hpp"
#include "tessera/program/printable.hpp"
#include "tessera/time_series.hpp"

namespace tessera::apps {
namespace {

using Json = nlohmann::ordered_json;

/// Adds 0 to remove the sign of -0, which descending axes may have.
std::string triple(const glm::dvec3& with_signs) {
  const glm::dvec3 v = with_signs + 0.0;
  return fmt::format("({:.9g} {:.9g} {:.9g})", v.x, v.y, v.z);
}

std::string lattice_line(const GridGeometry& g) {
  std::string line = fmt::format("{}x{}x{} points, origin {}", g.points[0], g.points[1], g.points[2], triple(g.origin));
  if (g.rectilinear())
    line += ", rectilinear";
  else
    line += fmt::format(", spacing {}", triple(g.spacing));
  if (g.direction != glm::dmat3(1.0))
    line += fmt::format(", axes {} {} {}", triple(g.direction[0]), triple(g.direction[1]), triple(g.direction[2]));
  return line;
}

/// The time steps of a file or series, and the step that the other lines describe.
struct Steps {
  std::size_t count = 1, at = 0;
  std::vector<double> times;                     ///< times, or the numbers of the steps if there are no times; may be
                                                 ///< empty
  bool timed = false;                            ///< `times` contains times, not numbers
  std::optional<std::array<double, 2>> range{};  ///< range of values that the images of all steps use
};

std::string steps_line(const Steps& steps) {
  std::string line = fmt::format("{}", steps.count);
  if (!steps.times.empty()) {
    constexpr std::size_t most = 12;
    line += steps.timed ? ", at times " : ", numbered ";
    for (std::size_t k = 0; k < steps.times.size(); ++k) {
      if (steps.times.size() > most && k == most - 2) line += ", ...", k = steps.times.size() - 1;
      line += fmt::format("{}{:.6g}", k == 0 ? "" : ", ", steps.times[k]);
    }
  }
  return line + fmt::format("; the lines below are for step {} of 0 to {}", steps.at, steps.count - 1);
}

void print_text(const std::filesystem::path& input, const analysis::Description& data,
                const LoadedTransferFunction& loaded, const Camera& view, const Steps& steps) {
  fmt::print("file      {}\n", printable(input.string()));
  fmt::print("format    {}\n", printable(data.format));
  if (steps.count > 1) fmt::print("steps     {}\n", steps_line(steps));
  if (data.is_mesh) {
    fmt::print("cells     {}\n", cells_line(data.counts));
    fmt::print("points    {}, {} of them not in any kept cell\n", data.counts.points_read, data.counts.points_unused);
  } else {
    fmt::print("lattice   {}\n", lattice_line(data.geometry));
    fmt::print("samples   {}\n", printable(samples_line(data)));
  }
  fmt::print("bounds    {} to {}, diagonal {:.6g}\n", triple(data.box.low), triple(data.box.high), diagonal(data.box));
  std::size_t widest = 0;
  std::vector<std::string> names;
  for (const auto& field : data.fields) names.push_back(printable(field.name));
  for (const std::string& name : names) widest = std::max(widest, name.size());
  const char* title = "fields";
  for (std::size_t f = 0; f < names.size(); ++f) {
    const auto& field = data.fields[f];
    fmt::print("{:<9} {:<{}}  {:<5}  {:<7} x {}  {:.6g} to {:.6g}{}\n", title, names[f], widest,
               analysis::word(field.association), printable(field.type), field.components, field.low, field.high,
               field.nan_count > 0 ? fmt::format(", {} NaN or infinite", field.nan_count) : "");
    title = "";
  }
  if (data.blocks.size() > 1) {
    constexpr std::size_t most = 200;
    std::string list;
    for (const auto& name : std::span(data.blocks).first(std::min(data.blocks.size(), most)))
      list += (list.empty() ? "" : ", ") + printable(name);
    if (data.blocks.size() > most) list += fmt::format(" and {} more (--json has all)", data.blocks.size() - most);
    fmt::print("blocks    {}\n", list);
  }
  const std::array<double, 2> range = steps.range.value_or(data.range);
  fmt::print("renders   field {}, {:.6g} to {:.6g}; {}; view {}\n", printable(data.field_name), range[0], range[1],
             printable(transfer_function_line(loaded)), view_line(view));
  for (const auto& warning : data.warnings) fmt::print("warning   {}\n", printable(warning));
  for (const auto& note : data.notes) fmt::print("note      {}\n", printable(note));
}

void print_finding(const char* name, const MeshCheck::Finding& finding, const std::string& more = "",
                   bool pairs = false) {
  fmt::print("  {:<21} {}{}\n", name, finding.count, more);
  for (const auto& place : finding.places)
    fmt::print("    {}{} at ({:.9g} {:.9g} {:.9g}){}\n", place.cell,
               place.other != place.cell ? fmt::format(" and {}", place.other)
               : pairs                   ? " and itself"
                                         : "",
               place.at.x, place.at.y, place.at.z, place.value > 0 ? fmt::format(", {:.3g}", place.value) : "");
}

void print_check(const MeshCheck& check) {
  fmt::print("check     {} tets, {} points: {}\n", check.tets, check.points,
             check.clean() ? "no cells overlap or fold, and all faces match"
                           : "cells overlap, fold or do not match; images are wrong where cells overlap");
  print_finding("overlapping pairs", check.overlaps,
                fmt::format("{}, {} cells", check.more_overlaps ? " or more" : "", check.overlapping_cells), true);
  print_finding("folded tets", check.inverted);
  print_finding("non-conforming faces", check.non_conforming_faces);
  print_finding("flat tets", check.flat);
  print_finding("slivers above 100:1", check.slivers,
                fmt::format(", {} above 1e4, {} above 1e6, worst {:.3g}", check.slivers_1e4, check.slivers_1e6,
                            check.worst_aspect));
  print_finding("duplicate points", check.duplicate_points);
  fmt::print("  {:<21} {} right-handed, {} left-handed\n", "orientation", check.right_handed, check.left_handed);
}

}  // namespace

namespace {

/// The opened input, and the options that its images use.
struct Opened {
  std::optional<Dataset> data;
  LoadedTransferFunction function;
  Steps steps;
  std::string note;
};

Opened open_file(const InputFile& input, const ReadOptions& options, StatusLine& line) {
  Opened opened;
  opened.data.emplace(open_watched(input, options, line));
  const Dataset& data = *opened.data;
  opened.steps = {data.time_steps(),
                  options.time_step.value_or(data.time_steps() - 1),
                  {data.times().begin(), data.times().end()},
                  !data.times().empty(),
                  {}};
  opened.function = transfer_function_of(data, RenderOptions{});
  return opened;
}

/// Opens the requested step as `render` does for a single step or, without a request, the first step as in a film of
/// all steps.
Opened open_series(const std::filesystem::path& input, ReadOptions options, StatusLine& line) {
  const std::vector<TimeStep> series = read_time_series(input);
  const std::optional<std::size_t> requested = std::exchange(options.time_step, std::nullopt);
  if (requested && *requested >= series.size())
    throw bad_input(fmt::format("{}: there is no time step {}, it has only {}; count from 0", input.string(),
                                *requested, series.size()));
  Opened opened;
  opened.steps = {series.size(), requested.value_or(0), {}, true, {}};
  const OpenStep open_step = [&](std::size_t step, const ReadOptions& read) -> const Dataset* {
    opened.data.reset();  // only one step in memory at a time
    line.begin("reading " + series[step].files.front().filename().string());
    ReadOptions watched = read;
    watched.progress = line.listener();
    try {
      opened.data.emplace(Dataset::open(series[step].files, watched));
    } catch (const Error&) {
      if (step == opened.steps.at) throw;
      return nullptr;
    }
    return &*opened.data;
  };
  RenderOptions pictures;
  pictures.read = options;
  if (!requested && depends_on_steps(series.size(), pictures)) {
    const SeriesChoice choice = choose_by_steps(steps_to_examine(series.size()), pictures, options, open_step);
    opened.function = *choice.function;
    opened.steps.range = choice.range;
    opened.note = series_note(choice, series.size(), opened.data->field_name());
  } else {
    open_step(opened.steps.at, options);
    opened.function = transfer_function_of(*opened.data, pictures);
  }
  for (const TimeStep& step : series) {
    opened.steps.times.push_back(step.time);
    opened.steps.timed = opened.steps.timed && step.has_time;
  }
  return opened;
}

Json steps_json(const Steps& steps) {
  return {{"count", steps.count},
          {"step", steps.at},
          {steps.timed ? "times" : "numbers", steps.times.empty() ? Json() : Json(steps.times)},
          {"range", steps.range ? Json(*steps.range) : Json()}};
}

}  // namespace

void info(const std::filesystem::path& input, const InputFile& first, const ReadOptions& options, bool as_json,
          bool check) {
  StatusLine line(shows_progress(false));
  const Opened opened = is_time_series(input) ? open_series(input, options, line) : open_file(first, options, line);
  const Dataset& data = *opened.data;
  std::optional<MeshCheck> checked;
  if (check) {
    line.begin("checking " + input.filename().string());
    checked = data.check([&line](double done) { line.advance(done); });
  }
  line.begin("looking through " + input.filename().string());
  analysis::Description description = described(data);
  if (!opened.note.empty()) description.notes.push_back(opened.note);
  const LoadedTransferFunction& loaded = opened.function;
  const ImageSize size;
  const Camera view = data.default_camera(size);
  line.begin("");
  if (!as_json) {
    print_text(input, description, loaded, view, opened.steps);
    if (checked) print_check(*checked);
    return;
  }
  auto json = analysis::data_json(input, description);
  if (opened.steps.count > 1) json["time_steps"] = steps_json(opened.steps);
  json["renders"] = {{"transfer_function", analysis::transfer_function_json(loaded)},
                     {"view", analysis::view_json(view, size)}};
  if (checked) json["check"] = analysis::check_json(*checked);
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace tessera::apps
