// SPDX-License-Identifier: BSD-3-Clause
// Data sets from callers' arrays and samples.
#include "api/communicator.hpp"
#include "api/dataset.hpp"
#include "frame/mesh/array_mesh.hpp"
#include "frame/ranks/curved_parts.hpp"
#include "scene/error.hpp"
#include "scene/number_type.hpp"

namespace tessera {
inline namespace v0_1 {
namespace {

FieldInfo only_field(const std::string& name, Association association, const char* type,
                     const scene::MeshFacts& facts) {
  return {name, association, 1, type, facts.scalar_range[0], facts.scalar_range[1], 0, true};
}

}  // namespace

Dataset Dataset::of(const MeshArrays& arrays) {
  auto state = std::make_shared<State>();
  frame::ArrayMesh mesh = frame::mesh_of_arrays(arrays, false);
  state->mesh = mesh.mesh;
  state->owner = std::move(mesh.owner);
  state->counts = mesh.counts;
  state->higher_order = mesh.higher_order;
  state->notes = std::move(mesh.notes);
  state->facts = scene::facts_of(state->mesh);
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
  if (!type) throw scene::bad_input("grid: 64-bit integer samples are not supported; give float64");
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
  state->ranges = std::make_shared<const volume::CellRanges>(*state->samples);
  if (state->ranges->range.empty())
    throw scene::bad_input("grid: none of its samples is finite; give a field that has values");
  api::complete_grid(*state);
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
  return api::together(*transport, [&] {
    auto state = std::make_shared<State>();
    frame::ArrayMesh mesh = frame::mesh_of_part(part, *transport);
    state->mesh = mesh.mesh;
    state->owner = std::move(mesh.owner);
    state->counts = mesh.counts;
    state->higher_order = mesh.higher_order;
    state->notes = std::move(mesh.notes);
    state->facts = frame::agree_facts(*transport, state->mesh);
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

}  // namespace v0_1
}  // namespace tessera
