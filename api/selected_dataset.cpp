// SPDX-License-Identifier: BSD-3-Clause
// A selected part of a data set, and the whole data set from which it was cut.
#include "api/selected_dataset.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "cells/mesh_selection.hpp"
#include "exchange/transport.hpp"
#include "frame/mesh/mesh_input.hpp"
#include "frame/ranks/mesh_exchange.hpp"
#include "frame/ranks/reduce.hpp"
#include "scene/error.hpp"
#include "scene/threads.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

scene::TetMesh copy_of(const scene::TetMeshView& view) {
  scene::TetMesh mesh;
  mesh.positions.assign(view.positions.begin(), view.positions.end());
  mesh.tets.assign(view.tets.begin(), view.tets.end());
  mesh.scalars.assign(view.scalars.begin(), view.scalars.end());
  mesh.association = view.association;
  mesh.original_cell.assign(view.original_cell.begin(), view.original_cell.end());
  mesh.field_name = view.field_name;
  return mesh;
}

/// Applies one step of a selection to a whole mesh: the threshold or the clip.
Dataset selected_part(const std::shared_ptr<const Dataset::State>& from, const Selection& selection) {
  auto state = std::make_shared<Dataset::State>();
  scene::TetMesh mesh = copy_of(from->mesh);
  state->counts = from->counts;
  cells::select(mesh, selection, state->counts, from->source);
  cells::require_selected(state->counts, from->source);
  auto kept = std::make_shared<const scene::TetMesh>(std::move(mesh));
  state->mesh = *kept;
  state->owner = std::move(kept);
  state->facts = scene::facts_of(state->mesh);
  state->of_all =
      from->of_all ? from->of_all
                   : std::make_shared<const frame::FieldOfAll>(frame::FieldOfAll{from->facts, from->field_samples()});
  state->source = from->source, state->format = from->format, state->field_name = from->field_name;
  state->fields = from->fields, state->notes = from->notes, state->blocks = from->blocks,
  state->surfaces = from->surfaces;
  state->higher_order = from->higher_order;
  state->time_step = from->time_step;
  state->axis_scale = from->axis_scale;
  state->options = from->options;
  state->shape = from->shape;
  if (!selection.clip.empty()) {
    state->clip = selection.clip;
    state->uncut = from;
  }
  return StateAccess::make(std::move(state));
}

}  // namespace

Dataset Dataset::selected(const Selection& selection) const {
  validate(selection);
  if (is_grid())
    throw scene::bad_input(state_->source +
                           ": it is a grid, whose cells cannot be selected; select only cells of meshes");
  if (state_->ranks > 1)
    throw scene::bad_input(state_->source +
                           ": this rank has a part of the mesh; open it with ReadOptions::selection instead");
  Dataset part = *this;
  if (selection.threshold) part = selected_part(part.state_, {{}, selection.threshold});
  if (!selection.clip.empty()) part = selected_part(part.state_, {selection.clip, {}, selection.levels});
  return part;
}

}  // namespace v0_1

namespace api {

frame::UncutMesh uncut_mesh(const Dataset::State& data) {
  if (data.ranks == 1 && data.clip.empty()) return {data.mesh, {}, data.mesh, nullptr};
  if (data.uncut) return {data.uncut->mesh, data.clip, data.mesh, data.uncut};
  if (data.files.empty())
    throw scene::bad_input(
        "verify: this rank has only a part of the mesh, and no file contains the whole mesh; verify on one rank");
  const auto pieces = frame::identify_pieces(data.files, frame::identify_input(data.files.front()));
  const ReadOptions& options = data.options;
  cells::MeshFile file = scene::with_threads(options.threads, [&] { return io::read_mesh(pieces, options); });
  cells::select(file.mesh, {{}, options.selection.threshold}, file.counts, data.source);
  const auto whole = std::make_shared<const scene::TetMesh>(std::move(file.mesh));
  return {*whole, data.clip, data.ranks == 1 ? data.mesh : scene::TetMeshView(*whole), whole};
}

void clip_box(Dataset::State& grid, const std::string& source) {
  const scene::GridGeometry& g = grid.samples->geometry();
  // The box of the grid as six tets around its diagonal.
  scene::TetMesh mesh;
  for (int n = 0; n < 8; ++n) {
    glm::dvec3 local;
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      local[axis] = g.lattice(a, (n >> axis & 1) != 0 ? g.points[a] - 1 : 0);
    }
    mesh.positions.push_back(g.origin + g.direction * local);
  }
  mesh.scalars.assign(8, 0.0);
  for (const auto& [first, second] : {std::array{1u, 3u}, {3u, 2u}, {2u, 6u}, {6u, 4u}, {4u, 5u}, {5u, 1u}})
    mesh.tets.push_back({0, first, second, 7});
  MeshCounts counts;
  cells::select(mesh, {grid.clip}, counts, source);
  cells::require_selected(counts, source);
  grid.facts.box = scene::bounds(mesh);
}

}  // namespace api
}  // namespace tessera
