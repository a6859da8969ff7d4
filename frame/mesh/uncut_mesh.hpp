// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::frame {

/// What a picture of a mesh is judged by: the mesh before it was clipped, and the half-spaces that rays are kept in. So
/// nothing that cells were cut by has a part in the reference.
struct UncutMesh {
  scene::TetMeshView mesh;
  std::span<const scene::HalfSpace> kept;  ///< of the data set's state; none: the mesh is what is rendered
  scene::TetMeshView rendered;             ///< the mesh as it is rendered; `mesh` where this rank has not all of it
  std::shared_ptr<const void> owner;       ///< of `mesh`; null: the data set's state
};

}  // namespace tessera::frame
