// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "cells/mesh_assembly.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

namespace tessera::frame {

/// A caller's mesh in the form that the renderer needs.
struct ArrayMesh {
  scene::TetMeshView mesh;
  std::shared_ptr<const void> owner;  ///< keeps the caller's arrays, or the converted ones, in memory
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<std::string> notes;
};

/// Borrows the arrays if they have the layout that the renderer needs and no value is blank; otherwise converts them
/// like those of a file. `may_be_empty`: the arrays are a part of a mesh; duplicate cells are then counted together
/// with those of the other parts, not here. `planning` is called once, with an empty list of blocks if there is nothing
/// to convert. Throws Error(bad_input) that names the array and the position.
ArrayMesh mesh_of_arrays(const MeshArrays& arrays, bool may_be_empty,
                         const cells::HigherOrderPlanning& planning = cells::plan_higher_order);

/// Converts the arrays for callers that only write the mesh: arrays are borrowed without checking their values.
ArrayMesh mesh_to_write(const MeshArrays& arrays);

/// Describes an existing mesh by the arrays of a caller; they are borrowed from `owner`.
MeshArrays arrays_of(const scene::TetMeshView& mesh, std::string field_name, std::shared_ptr<const void> owner);

}  // namespace tessera::frame
