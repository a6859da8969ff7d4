// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "cells/mesh_assembly.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

namespace tessera::frame {

/// A caller's mesh in the renderer's form.
struct ArrayMesh {
  scene::TetMeshView mesh;
  std::shared_ptr<const void> owner;  ///< of the caller's arrays, or of the converted ones
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<std::string> notes;
};

/// Borrows the arrays if they have the layout that the renderer needs and nothing is blank; otherwise converts them as
/// those of a file. `may_be_empty`: for a part; duplicate cells are then counted together with those of the other
/// parts, not here. `planning` is called once, without blocks if there is nothing to convert. Throws Error(bad_input)
/// naming array and place.
ArrayMesh mesh_of_arrays(const MeshArrays& arrays, bool may_be_empty,
                         const cells::HigherOrderPlanning& planning = cells::plan_higher_order);

/// The same for callers that only write it: borrowed whatever its numbers are.
ArrayMesh mesh_to_write(const MeshArrays& arrays);

/// An existing mesh as a caller's arrays, borrowed from `owner`.
MeshArrays arrays_of(const scene::TetMeshView& mesh, std::string field_name, std::shared_ptr<const void> owner);

}  // namespace tessera::frame
