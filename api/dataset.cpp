// SPDX-License-Identifier: BSD-3-Clause
#include "api/dataset.hpp"

#include <algorithm>

#include "api/queries/mesh_check.hpp"
#include "api/transfer_function_choice.hpp"
#include "cells/mesh_assembly.hpp"
#include "colormaps/presets.hpp"
#include "frame/mesh/array_mesh.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera {
inline namespace v0_1 {

std::shared_ptr<const projection::PreparedMesh> Dataset::State::prepared(int threads, scene::Trace* trace) const {
  std::call_once(once_, [&] {
    const scene::TraceScope timing(trace, "prepare");
    prepared_ = scene::with_threads(threads, [&] { return std::make_shared<const projection::PreparedMesh>(mesh); });
  });
  return prepared_;
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
  if (is_grid())
    throw scene::bad_input(state_->source + ": it is a grid, which has no tets; request them only from meshes");
  return frame::arrays_of(state_->mesh, state_->field_name, state_);
}

const GridGeometry& Dataset::grid_geometry() const {
  if (is_mesh())
    throw scene::bad_input(state_->source + ": it is a mesh, which has no lattice; request it only from grids");
  return state_->samples->geometry();
}
SampleType Dataset::sample_type() const {
  if (is_mesh())
    throw scene::bad_input(state_->source + ": it is a mesh, which has no samples; request them only from grids");
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
  if (is_grid()) throw scene::bad_input(state_->source + ": it is a grid, but only meshes can be checked; give a mesh");
  if (state_->ranks > 1)
    throw scene::bad_input(state_->source + ": this rank has a part of the mesh; open it on one rank to check it");
  return api::check_mesh(state_->mesh, progress);
}

std::vector<std::string> preset_names() { return colormaps::preset_names(); }

}  // namespace v0_1

namespace api {

scene::MeshFacts facts_of_grid(const scene::Grid& grid, const scene::ValueRange& range) {
  return {scene::bounds(grid.geometry),
          {range.low, range.high},
          scene::mean_thickness(grid.geometry),
          0,
          grid.geometry.association};
}

void complete_grid(Dataset::State& state) {
  const scene::Grid& grid = state.samples->grid();
  state.field_name = grid.field_name;
  state.facts = facts_of_grid(grid, state.ranges->range);
}

}  // namespace api
}  // namespace tessera
