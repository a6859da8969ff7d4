// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/arrays.hpp"

#include <cstring>
#include <memory>
#include <utility>

namespace tessera::datasets {

MeshArrays arrays_of(scene::TetMesh mesh) {
  auto kept = std::make_shared<const scene::TetMesh>(std::move(mesh));
  MeshArrays arrays;
  arrays.points = ArrayView(kept->positions);
  arrays.tets = ArrayView(kept->tets.data(), 4 * kept->tets.size(), NumberType::uint32);
  arrays.scalars = ArrayView(kept->scalars);
  arrays.association = kept->association;
  arrays.field_name = kept->field_name;
  arrays.original_cells = ArrayView(kept->original_cell);
  arrays.owner = std::move(kept);
  return arrays;
}

scene::TetMesh mesh_of(const MeshArrays& arrays) {
  const auto copied = [](const ArrayView& from, auto& to, std::size_t numbers_each) {
    to.resize(from.size() / numbers_each);
    if (!to.empty()) std::memcpy(to.data(), from.data(), to.size() * sizeof(to.front()));
  };
  scene::TetMesh mesh;
  copied(arrays.points, mesh.positions, 3);
  copied(arrays.tets, mesh.tets, 4);
  copied(arrays.scalars, mesh.scalars, 1);
  copied(arrays.original_cells, mesh.original_cell, 1);
  mesh.association = arrays.association;
  mesh.field_name = arrays.field_name;
  return mesh;
}

}  // namespace tessera::datasets
