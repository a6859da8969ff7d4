// SPDX-License-Identifier: BSD-3-Clause
#include "api/dataset.hpp"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "api/communicator.hpp"
#include "api/grid_values.hpp"
#include "api/input_file.hpp"
#include "api/queries/mesh_check.hpp"
#include "api/same_files.hpp"
#include "api/selected_dataset.hpp"
#include "api/transfer_function_choice.hpp"
#include "cells/axis_scale.hpp"
#include "cells/mesh_assembly.hpp"
#include "colormaps/presets.hpp"
#include "exchange/collectives.hpp"
#include "exchange/message.hpp"
#include "exchange/transport.hpp"
#include "frame/grid/scan_together.hpp"
#include "frame/grid/shared_volume.hpp"
#include "frame/mesh/array_mesh.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "frame/mesh/render.hpp"
#include "frame/ranks/curved_parts.hpp"
#include "frame/ranks/distributed_mesh.hpp"
#include "frame/ranks/roles.hpp"
#include "io/foreign/messages/foreign_data.hpp"
#include "io/volume/volume_reader.hpp"
#include "io/vtk/vtk_field_words.hpp"
#include "scene/error.hpp"
#include "scene/fill_value.hpp"
#include "scene/number_type.hpp"
#include "scene/scaled_source.hpp"
#include "scene/threads.hpp"
#include "scene/threshold_source.hpp"
#include "system/files_read.hpp"
#include "tessera/input_file.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

void check_grid_options(const std::filesystem::path& file, const ReadOptions& options) {
  const auto refuse = [&](const char* setting) {
    throw scene::bad_input(
        fmt::format("{}: `{}` is for meshes, and this is a grid; leave it out", file.string(), setting));
  };
  if (options.smooth) refuse("smooth");
  if (options.warp) refuse("warp");
  if (options.drop_duplicates) refuse("drop_duplicates");
  if (options.max_volume) refuse("max_volume");
  if (!options.blocks.empty()) refuse("block");
  if (!options.plot3d_q.empty()) refuse("plot3d_q");
}

void check_mesh_options(const std::filesystem::path& file, const ReadOptions& options) {
  if (options.describes_raw())
    throw scene::bad_input(
        fmt::format("{}: `dims`, `type`, `spacing`, `origin`, `endian` and `skip` are for .raw files; leave them out",
                    file.string()));
}

/// The same note on every rank.
void note_fill_value(exchange::Transport& transport, Dataset::State& state) {
  std::optional<scene::FillValue> fill = frame::find_fill_value(transport, state.mesh, state.facts);
  if (!fill) return;
  const bool of_points = state.facts.association == Association::point;
  if (of_points && transport.size() > 1) fill->count = 0;  // parts have the points between them in common
  state.notes.push_back(scene::words_on(*fill, of_points ? "points" : "tets"));
}

/// Of a file of one step, what its field data state.
void set_own_time(const io::InputFile& file, scene::TimeStepRead& read) {
  if (read.count > 1 || !read.times.empty()) return;
  if (const auto time = io::vtk_time_value(file.path, file.beginning)) read = {1, 0, {*time}};
}

void check_axis_scale(const std::optional<glm::dvec3>& scale) {
  if (!scale) return;
  for (int axis = 0; axis < 3; ++axis)
    if (!((*scale)[axis] > 0) || !std::isfinite((*scale)[axis]))
      throw scene::bad_input(
          fmt::format("`scale` is {} {} {}; each factor must be above 0", scale->x, scale->y, scale->z));
}

scene::MeshFacts facts_of(const scene::Grid& grid, const scene::ValueRange& range) {
  return {scene::bounds(grid.geometry),
          {range.low, range.high},
          scene::mean_thickness(grid.geometry),
          0,
          grid.geometry.association};
}

std::shared_ptr<Dataset::State> opened_grid(const io::InputFile& input, const ReadOptions& options,
                                            exchange::Transport& transport, scene::Trace* trace) {
  const std::filesystem::path& file = input.path;
  check_grid_options(file, options);
  auto state = std::make_shared<Dataset::State>();
  io::VolumeFile volume = [&] {
    const scene::TraceScope timing(trace, "read");
    return frame::open_shared_volume(transport, input, options);
  }();
  api::require_same_files(transport);  // which it names
  state->axis_scale = cells::chosen_scale(options.axis_scale, volume.beside_degrees,
                                          scene::bounds(volume.source->geometry()), volume.notes);
  if (state->axis_scale != glm::dvec3(1))
    volume.source = std::make_unique<scene::ScaledSource>(std::move(volume.source), state->axis_scale, file.string());
  {
    const scene::TraceScope timing(trace, "prepare");
    state->labels = api::take_labels(file, options, transport, volume);
    state->ranges =
        std::make_shared<const volume::CellRanges>(frame::scan_together(transport, *volume.source, options.threads));
  }
  api::note_byte_order(volume, options, state->ranges->range);
  api::leave_fill_values_out(volume, file, options, transport, state->ranges);
  scene::ValueRange range = state->ranges->range;
  if (const auto& threshold = options.selection.threshold) {
    state->of_all = std::make_shared<const frame::FieldOfAll>(
        frame::FieldOfAll{facts_of(volume.source->grid(), range), scene::sample_grid(*volume.source)});
    volume.source = std::make_unique<scene::ThresholdSource>(std::move(volume.source), *threshold, file.string());
    const scene::TraceScope timing(trace, "prepare");
    state->ranges =
        std::make_shared<const volume::CellRanges>(frame::scan_together(transport, *volume.source, options.threads));
    range = state->ranges->range;
    if (range.empty())
      throw scene::bad_input(fmt::format(
          "{}: no sample's value is in `threshold`, nothing is left to render; give a wider range", file.string()));
    if (range.blanks > 0)
      volume.notes.push_back(
          fmt::format("{} samples are blank or not in `threshold`: voxels that have one are left out",
                      std::exchange(range.blanks, 0)));
  }
  io::set_range(volume, file, range);
  state->fields = std::move(volume.fields);
  state->notes = std::move(volume.notes);
  state->format = std::move(volume.format);
  state->body_axes = volume.body_axes;
  state->tags = std::move(volume.tags);
  state->time_step = std::move(volume.time_step);
  set_own_time(input, state->time_step);
  state->samples = std::move(volume.source);
  return state;
}

/// Facts of a grid whose samples and ranges are known.
void complete_grid(Dataset::State& state) {
  const scene::Grid& grid = state.samples->grid();
  state.field_name = grid.field_name;
  state.facts = facts_of(grid, state.ranges->range);
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

/// Makes a mesh the state's own, its corners in the order that needs no copy unless theirs is to be kept.
void keep(scene::TetMesh mesh, const ReadOptions& options, scene::Trace* trace, Dataset::State& state) {
  if (!options.keep_corners) frame::order_corners(mesh, options.threads, trace);
  auto kept = std::make_shared<const scene::TetMesh>(std::move(mesh));
  state.mesh = *kept;
  state.owner = std::move(kept);
}

FieldInfo only_field(const std::string& name, Association association, const char* type,
                     const scene::MeshFacts& facts) {
  return {name, association, 1, type, facts.scalar_range[0], facts.scalar_range[1], 0, true};
}

/// This rank's error ends the run for all, and the run's one error is thrown on each.
template <class Work>
auto together(exchange::Transport& transport, const Work& work) {
  try {
    return work();
  } catch (const scene::Error& error) {
    if (transport.size() > 1) {
      transport.fail(error);
      transport.check();
    }
    throw;
  }
}

}  // namespace

std::shared_ptr<const projection::PreparedMesh> Dataset::State::prepared(int threads, scene::Trace* trace) const {
  std::call_once(once_, [&] {
    const scene::TraceScope timing(trace, "prepare");
    tbb::task_arena(scene::threads_for(threads)).execute([&] {
      prepared_ = std::make_shared<const projection::PreparedMesh>(mesh);
    });
  });
  return prepared_;
}

Dataset Dataset::open(const std::filesystem::path& file, const ReadOptions& options) {
  return open(std::span(&file, 1), options);
}

Dataset Dataset::open(std::span<const std::filesystem::path> files, const ReadOptions& options) {
  return open(files, options, Communicator());
}

namespace {

/// Spans of messages go to a face of the reader's trace while this lives.
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

  /// The face, or `alone` of one process.
  [[nodiscard]] Trace* face(Trace* alone) { return face_ ? &*face_ : alone; }

 private:
  exchange::Transport& transport_;
  std::optional<Trace> face_;
};

}  // namespace

namespace {

/// `identified`: the one file, if it has been.
Dataset open_together(std::span<const std::filesystem::path> files, std::optional<InputFile> identified,
                      const ReadOptions& options, const Communicator& communicator, const RankSettings& ranks) {
  using State = Dataset::State;
  const std::shared_ptr<exchange::Transport> transport = StateAccess::of(communicator).connect();
  return together(*transport, [&] {
    std::shared_ptr<State> state;
    if (files.empty()) throw scene::bad_input("input: no file is named; name one");
    check_axis_scale(options.axis_scale);
    for (const auto& file : files) system::note_read(file);
    api::require_same_files(*transport);  // first of all: what ranks do together goes by them
    if (!identified) identified.emplace(files.front());
    const io::InputFile& first = StateAccess::of(*identified).file;
    if (files.size() == 1 && identified->opens_as_grid(options)) {
      state = opened_grid(first, options, *transport, options.trace);
      complete_grid(*state);
      if (!options.selection.clip.empty()) api::clip_box(*state, options.selection, files.front().string());
    } else {
      check_mesh_options(files.front(), options);
      state = std::make_shared<State>();
      TracedMessages traced(*transport, options.trace);
      Trace* const trace = traced.face(options.trace);
      const Roles roles = assign_roles(transport->size(), ranks.projectors, ranks.compositors);
      frame::DistributedMesh mesh =
          frame::read_distributed(*transport, files, first, options, ranks.partition, roles.projectors, trace);
      api::require_same_files(*transport);  // which they name
      take_description(std::move(mesh.description), *state);
      set_own_time(first, state->time_step);
      state->facts = mesh.facts;
      state->of_all = std::move(mesh.of_all);
      state->ranks = transport->size();
      state->global_tet = std::move(mesh.part.global_tet);
      keep(std::move(mesh.part.mesh), options, trace, *state);
      if (!options.selection.threshold) note_fill_value(*transport, *state);
      state->shape = options.shape && state->field_name == shape_field_name;
      state->gather_field_samples(*transport);
    }
    state->source = files.front().string();
    state->files.assign(files.begin(), files.end());
    state->options = options;
    state->clip = options.selection.clip;
    state->options.trace = nullptr;  // which need not live as long
    state->options.progress = nullptr;
    return StateAccess::make(std::move(state));
  });
}

}  // namespace

Dataset Dataset::open(std::span<const std::filesystem::path> files, const ReadOptions& options,
                      const Communicator& communicator, const RankSettings& ranks) {
  return open_together(files, std::nullopt, options, communicator, ranks);
}

Dataset Dataset::open(const InputFile& file, const ReadOptions& options) { return open(file, options, Communicator()); }

Dataset Dataset::open(const InputFile& file, const ReadOptions& options, const Communicator& communicator,
                      const RankSettings& ranks) {
  return open_together(std::span(&file.path(), 1), file, options, communicator, ranks);
}

Dataset Dataset::of(const MeshArrays& arrays) {
  auto state = std::make_shared<State>();
  frame::ArrayMesh mesh = frame::mesh_of_arrays(arrays, false);
  state->mesh = mesh.mesh;
  state->owner = std::move(mesh.owner);
  state->counts = mesh.counts;
  state->higher_order = mesh.higher_order;
  state->notes = std::move(mesh.notes);
  state->facts = scene::facts_of(state->mesh, 0);
  state->source = "mesh";
  state->format = "arrays";
  state->field_name = arrays.field_name;
  state->fields = {
      only_field(arrays.field_name, arrays.association, scene::name_of(arrays.scalars.type()), state->facts)};
  return Dataset(std::move(state));
}

Dataset Dataset::of(const GridArrays& arrays) {
  scene::Grid grid;
  grid.geometry = arrays.geometry;
  const std::optional<SampleType> type = scene::sample_type_of(arrays.samples.type());
  if (!type) throw scene::bad_input("grid: samples are 64-bit integers; give float64");
  grid.type = *type;
  grid.scale = arrays.scale, grid.shift = arrays.shift;
  grid.field_name = arrays.field_name;
  const std::span bytes(static_cast<const std::byte*>(arrays.samples.data()),
                        arrays.samples.size() * scene::size_of(grid.type));
  return of(std::make_shared<const scene::MemorySource>(std::move(grid), bytes, arrays.owner, "grid"));
}

Dataset Dataset::of(std::shared_ptr<const SampleSource> samples) {
  auto state = std::make_shared<State>();
  state->samples = std::move(samples);
  state->ranges = std::make_shared<const volume::CellRanges>(*state->samples, 0);
  if (state->ranges->range.empty())
    throw scene::bad_input("grid: none of its samples is finite; give a field that has values");
  complete_grid(*state);
  state->source = "grid";
  state->format = "arrays";
  state->fields = {
      only_field(state->field_name, state->facts.association, name_of(state->samples->grid().type), state->facts)};
  state->fields.front().nan_count = state->ranges->range.blanks;
  return Dataset(std::move(state));
}

Dataset Dataset::of_parts(const MeshArrays& part, const Communicator& communicator) {
  if (communicator.size() == 1) return of(part);
  const std::shared_ptr<exchange::Transport> transport = StateAccess::of(communicator).connect();
  return together(*transport, [&] {
    auto state = std::make_shared<State>();
    frame::ArrayMesh mesh = frame::mesh_of_part(part, *transport);
    state->mesh = mesh.mesh;
    state->owner = std::move(mesh.owner);
    state->counts = mesh.counts;
    state->higher_order = mesh.higher_order;
    state->notes = std::move(mesh.notes);
    state->facts = frame::agree_facts(*transport, state->mesh, 0);
    if (state->facts.tets == 0) throw scene::bad_input("mesh: no rank has a cell; give at least one");
    state->ranks = transport->size();
    state->global_tet = frame::numbered_by_rank(*transport, state->mesh.tets.size());
    state->gather_field_samples(*transport);
    state->source = "mesh";
    state->format = "arrays";
    state->field_name = part.field_name;
    state->fields = {only_field(part.field_name, part.association, scene::name_of(part.scalars.type()), state->facts)};
    return Dataset(std::move(state));
  });
}

bool Dataset::is_mesh() const { return state_->samples == nullptr; }
const Box& Dataset::bounds() const { return state_->facts.box; }
const glm::dvec3& Dataset::axis_scale() const { return state_->axis_scale; }
std::array<double, 2> Dataset::range() const { return state_->facts_of_all().scalar_range; }
Association Dataset::association() const { return state_->facts.association; }
const std::string& Dataset::field_name() const { return state_->field_name; }
bool Dataset::shows_shape() const { return state_->shape; }
std::span<const FieldInfo> Dataset::fields() const { return state_->fields; }
std::span<const std::string> Dataset::notes() const { return state_->notes; }
std::vector<std::string> Dataset::warnings() const {
  return cells::warnings_on_cells(state_->counts, state_->higher_order);
}
std::size_t Dataset::time_steps() const { return std::max<std::size_t>(state_->time_step.count, 1); }
std::span<const double> Dataset::times() const { return state_->time_step.times; }
std::optional<double> Dataset::time() const {
  const scene::TimeStepRead& read = state_->time_step;
  return read.step < read.times.size() ? std::optional(read.times[read.step]) : std::nullopt;
}
std::span<const std::string> Dataset::blocks() const { return state_->blocks; }
std::span<const std::string> Dataset::surfaces() const { return state_->surfaces; }
const std::string& Dataset::format() const { return state_->format; }
const std::string& Dataset::source() const { return state_->source; }
std::uint64_t Dataset::tet_count() const { return state_->facts.tets; }
const MeshCounts& Dataset::mesh_counts() const { return state_->counts; }
const HigherOrderCells& Dataset::higher_order_cells() const { return state_->higher_order; }

MeshArrays Dataset::mesh_arrays() const {
  if (is_grid()) throw scene::bad_input(state_->source + ": is a grid, which has no tets; ask meshes for them");
  return frame::arrays_of(state_->mesh, state_->field_name, state_);
}

const GridGeometry& Dataset::grid_geometry() const {
  if (is_mesh()) throw scene::bad_input(state_->source + ": is a mesh, which has no lattice; ask grids for it");
  return state_->samples->geometry();
}
SampleType Dataset::sample_type() const {
  if (is_mesh()) throw scene::bad_input(state_->source + ": is a mesh, which has no samples; ask grids for it");
  return state_->samples->grid().type;
}
double Dataset::scale() const { return is_mesh() ? 1 : state_->samples->grid().scale; }
double Dataset::shift() const { return is_mesh() ? 0 : state_->samples->grid().shift; }
std::uint64_t Dataset::blank_samples() const { return is_mesh() ? 0 : state_->ranges->range.blanks; }

double Dataset::default_unit_distance() const { return frame::default_unit_distance(state_->facts_of_all()); }

Camera Dataset::default_camera(ImageSize size, ProjectionKind projection) const { return view({}, size, projection); }

View Dataset::default_view(ImageSize size, ProjectionKind projection) const {
  return {default_camera(size, projection), size};
}

Camera Dataset::view(const ViewRequest& request, ImageSize size, ProjectionKind projection, bool turning) const {
  validate(size);
  return view_of_box(bounds(), size, request, projection, body_axes(), turning);
}

BodyAxes Dataset::body_axes() const { return state_->body_axes; }

LoadedTransferFunction Dataset::transfer_function(const std::string& file_or_preset,
                                                  const TransferFunctionOptions& options) const {
  return api::transfer_function_of(*state_, file_or_preset, options);
}

MeshCheck Dataset::check(const CheckProgressFunction& progress) const {
  if (is_grid()) throw scene::bad_input(state_->source + ": is a grid, which nothing can be wrong with; check meshes");
  if (state_->ranks > 1)
    throw scene::bad_input(state_->source + ": this rank has a part of the mesh; open it on one rank to check it");
  return api::check_mesh(state_->mesh, progress);
}

std::vector<std::string> preset_names() { return colormaps::preset_names(); }

}  // namespace v0_1
}  // namespace tessera
