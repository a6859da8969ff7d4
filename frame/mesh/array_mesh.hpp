// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include "cells/mesh_assembly.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

namespace tessera::frame {

/// A caller's mesh as the renderer sees it.
struct ArrayMesh {
  scene::TetMeshView mesh;
  std::shared_ptr<const void> owner;  ///< of the caller's arrays, or of what was made of them
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<std::string> notes;
};

/// Borrows the arrays where they are laid out as the renderer wants them and nothing is blank, else converts them as a
/// file's. `may_be_empty`: of a part; duplicate cells are then counted with those of the other parts, not here.
/// `planning` is called once, of no blocks where there is nothing to convert. Throws Error(bad_input) naming array and
/// place.
ArrayMesh mesh_of_arrays(const MeshArrays& arrays, bool may_be_empty,
                         const cells::HigherOrderPlanning& planning = cells::plan_higher_order);

/// The same for who only writes it: borrowed whatever its numbers are.
ArrayMesh mesh_to_write(const MeshArrays& arrays);

/// A mesh that is there already, as a caller has it: borrowed from `owner`.
MeshArrays arrays_of(const scene::TetMeshView& mesh, std::string field_name, std::shared_ptr<const void> owner);

}  // namespace tessera::frame
