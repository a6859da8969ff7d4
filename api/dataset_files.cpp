// SPDX-License-Identifier: BSD-3-Clause
// Data sets from files.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "api/grid_values.hpp"
#include "api/input_file.hpp"
#include "api/same_files.hpp"
#include "api/selected_dataset.hpp"
#include "cells/axis_scale.hpp"
#include "exchange/transport.hpp"
#include "frame/grid/scan_together.hpp"
#include "frame/grid/shared_volume.hpp"
#include "frame/ranks/distributed_mesh.hpp"
#include "frame/ranks/roles.hpp"
#include "io/volume/volume_reader.hpp"
#include "io/vtk/vtk_field_words.hpp"
#include "projection/prepared_mesh.hpp"
#include "scene/error.hpp"
#include "scene/fill_value.hpp"
#include "scene/scaled_source.hpp"
#include "scene/threads.hpp"
#include "scene/threshold_source.hpp"
#include "system/files_read.hpp"
#include "system/missing_file.hpp"
#include "tessera/input_file.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

/// Throws Error(bad_input) for options that do not apply to a file of this kind.
void check_options(const std::filesystem::path& file, const ReadOptions& options, bool is_grid) {
  if (const auto& scale = options.axis_scale)
    for (int axis = 0; axis < 3; ++axis)
      if (!((*scale)[axis] > 0) || !std::isfinite((*scale)[axis]))
        throw scene::bad_input(
            fmt::format("`scale` is {} {} {}; each factor must be above 0", scale->x, scale->y, scale->z));
  if (!is_grid && options.describes_raw())
    throw scene::bad_input(fmt::format(
        "{}: `dims`, `type`, `spacing`, `origin`, `endian` and `skip` are only for .raw files; leave them out",
        file.string()));
  const auto refuse = [&](bool is_given, const char* setting) {
    if (is_grid && is_given)
      throw scene::bad_input(
          fmt::format("{}: `{}` is for meshes, but this is a grid; leave it out", file.string(), setting));
  };
  refuse(options.smooth, "smooth");
  refuse(options.warp.has_value(), "warp");
  refuse(options.drop_duplicates, "drop_duplicates");
  refuse(options.max_volume.has_value(), "max_volume");
  refuse(!options.blocks.empty(), "block");
  refuse(!options.plot3d_q.empty(), "plot3d_q");
}

/// Adds the same note about fill values on every rank.
void note_fill_value(exchange::Transport& transport, Dataset::State& state) {
  std::optional<scene::FillValue> fill = frame::find_fill_value(transport, state.mesh, state.facts);
  if (!fill) return;
  const bool of_points = state.facts.association == Association::point;
  if (of_points && transport.size() > 1)
    fill->count = 0;  // adjacent parts both count the points between them, so the
                      // sum is unknown
  state.notes.push_back(scene::words_on(*fill, of_points ? "points" : "tets"));
}

/// For a file with one step: sets the time to that in the file's field data.
void set_own_time(const io::InputFile& file, scene::TimeStepRead& read) {
  if (read.count > 1 || !read.times.empty()) return;
  if (const auto time = io::vtk_time_value(file.path, file.beginning)) read = {1, 0, {*time}};
}

std::shared_ptr<Dataset::State> opened_grid(const io::InputFile& input, const ReadOptions& options,
                                            exchange::Transport& transport) {
  const std::filesystem::path& file = input.path;
  auto state = std::make_shared<Dataset::State>();
  io::VolumeFile volume = [&] {
    const scene::TraceScope timing(options.trace, "read");
    return frame::open_shared_volume(transport, input, options);
  }();
  api::require_same_files(transport);  // the files to which `volume` refers
  state->axis_scale = cells::chosen_scale(options.axis_scale, volume.xy_in_degrees,
                                          scene::bounds(volume.source->geometry()), volume.notes);
  if (state->axis_scale != glm::dvec3(1))
    volume.source = std::make_unique<scene::ScaledSource>(std::move(volume.source), state->axis_scale, file.string());
  {
    const scene::TraceScope timing(options.trace, "prepare");
    state->labels = api::take_labels(file, options.labels, transport, volume);
    state->ranges = std::make_shared<const volume::CellRanges>(frame::scan_together(transport, *volume.source));
  }
  api::note_byte_order(volume, options.big_endian, state->ranges->range);
  api::leave_fill_values_out(volume, file, options.selection.threshold, transport, state->ranges);
  scene::ValueRange range = state->ranges->range;
  if (const auto& threshold = options.selection.threshold) {
    state->of_all = std::make_shared<const frame::FieldOfAll>(
        frame::FieldOfAll{api::facts_of_grid(volume.source->grid(), range), scene::sample_grid(*volume.source)});
    volume.source = std::make_unique<scene::ThresholdSource>(std::move(volume.source), *threshold, file.string());
    const scene::TraceScope timing(options.trace, "prepare");
    state->ranges = std::make_shared<const volume::CellRanges>(frame::scan_together(transport, *volume.source));
    range = state->ranges->range;
    if (range.empty())
      throw scene::bad_input(fmt::format(
          "{}: no sample's value is in `threshold`, so nothing is left to render; give a wider range", file.string()));
    if (range.blanks > 0)
      volume.notes.push_back(
          fmt::format("{} samples are blank or not in `threshold`: voxels with such a sample are left out",
                      std::exchange(range.blanks, 0)));
  }
  io::set_range(volume, file, range);
  state->fields = std::move(volume.fields);
  state->notes = std::move(volume.notes);
  state->format = std::move(volume.format);
  state->body_axes = volume.body_axes;
  state->tags = std::move(volume.tags);
  state->time_step = std::move(volume.time_step);
  state->samples = std::move(volume.source);
  api::complete_grid(*state);
  state->clip = options.selection.clip;
  if (!state->clip.empty()) api::clip_box(*state, file.string());
  return state;
}

void take_description(cells::MeshFile&& file, Dataset::State& state) {
  state.field_name = std::move(file.mesh.field_name);
  state.fields = std::move(file.fields);
  state.notes = std::move(file.notes);
  state.blocks = std::move(file.blocks);
  state.surfaces = std::move(file.surfaces);
  state.format = std::move(file.format);
  state.counts = file.counts;
  state.higher_order = file.higher_order;
  state.time_step = std::move(file.time_step);
  state.axis_scale = file.axis_scale;
}

/// While it exists, spans of messages are recorded in the reader's trace.
class TracedMessages {
 public:
  TracedMessages(exchange::Transport& transport, Trace* trace) : transport_(transport) {
    if (trace == nullptr || transport.size() == 1) return;
    face_.emplace(*trace, TraceRole::projector);
    transport_.trace_to(&*face_, nullptr);
  }
  ~TracedMessages() {
    if (face_) transport_.trace_to(nullptr, nullptr);
  }
  TracedMessages(const TracedMessages&) = delete;
  TracedMessages& operator=(const TracedMessages&) = delete;

  /// The trace that also records messages or, for a single process, `alone`.
  [[nodiscard]] Trace* face(Trace* alone) { return face_ ? &*face_ : alone; }

 private:
  exchange::Transport& transport_;
  std::optional<Trace> face_;
};

std::shared_ptr<Dataset::State> opened_mesh(std::span<const std::filesystem::path> files, const io::InputFile& first,
                                            ReadOptions options, exchange::Transport& transport,
                                            const RankSettings& ranks) {
  auto state = std::make_shared<Dataset::State>();
  TracedMessages traced(transport, options.trace);
  options.trace = traced.face(options.trace);
  const Roles roles = assign_roles(transport.size(), ranks.projectors, ranks.compositors);
  frame::DistributedMesh mesh =
      frame::read_distributed(transport, files, first, options, ranks.partition, roles.projectors);
  api::require_same_files(transport);  // the files to which the mesh's files refer
  take_description(std::move(mesh.description), *state);
  state->facts = mesh.facts;
  state->of_all = std::move(mesh.of_all);
  state->ranks = transport.size();
  state->global_tet = std::move(mesh.part.global_tet);
  if (!options.keep_corners) {
    const scene::TraceScope timing(options.trace, "prepare");
    projection::order_corners(mesh.part.mesh);
  }
  auto kept = std::make_shared<const scene::TetMesh>(std::move(mesh.part.mesh));
  state->mesh = *kept;
  state->owner = std::move(kept);
  if (!options.selection.threshold) note_fill_value(transport, *state);
  state->shape = options.shape && state->field_name == shape_field_name;
  state->gather_field_samples(transport);
  return state;
}

/// `identified`: the file, if there is one and it has been identified.
Dataset open_together(std::span<const std::filesystem::path> files, std::optional<InputFile> identified,
                      const ReadOptions& options, const Communicator& communicator, const RankSettings& ranks) {
  const std::shared_ptr<exchange::Transport> transport = StateAccess::of(communicator).connect();
  const auto open = [&] {
    if (files.empty()) throw scene::bad_input("input: no file was given; give one");
    for (const auto& file : files) system::note_read(file);
    api::require_same_files(*transport);  // must come first: the collective calls below depend on the files
    if (!identified) identified.emplace(files.front());
    if (!StateAccess::of(*identified).is_there) throw system::missing_file(files.front());
    const io::InputFile& first = StateAccess::of(*identified).file;
    const bool is_grid = files.size() == 1 && identified->opens_as_grid(options);
    check_options(files.front(), options, is_grid);
    const std::shared_ptr<Dataset::State> state =
        is_grid ? opened_grid(first, options, *transport) : opened_mesh(files, first, options, *transport, ranks);
    set_own_time(first, state->time_step);
    if (auto note = scene::note_on(state->time_step, options.time_step.has_value()))
      state->notes.insert(state->notes.begin(), *std::move(note));
    state->source = files.front().string();
    state->files.assign(files.begin(), files.end());
    state->options = options;
    state->clip = options.selection.clip;
    state->options.trace = nullptr;  // the state may outlive the trace
    state->options.progress = nullptr;
    return StateAccess::make(state);
  };
  return scene::with_threads(options.threads, [&] { return api::together(*transport, open); });
}

}  // namespace

Dataset Dataset::open(const std::filesystem::path& file, const ReadOptions& options) {
  return open(std::span(&file, 1), options);
}

Dataset Dataset::open(std::span<const std::filesystem::path> files, const ReadOptions& options) {
  return open(files, options, Communicator());
}

Dataset Dataset::open(std::span<const std::filesystem::path> files, const ReadOptions& options,
                      const Communicator& communicator, const RankSettings& ranks) {
  return open_together(files, std::nullopt, options, communicator, ranks);
}

Dataset Dataset::open(const InputFile& file, const ReadOptions& options) { return open(file, options, Communicator()); }

Dataset Dataset::open(const InputFile& file, const ReadOptions& options, const Communicator& communicator,
                      const RankSettings& ranks) {
  return open_together(std::span(&file.path(), 1), file, options, communicator, ranks);
}

}  // namespace v0_1
}  // namespace tessera
