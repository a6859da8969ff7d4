// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::frame {

/// The reference for images of a clipped mesh: the mesh before it was clipped, and the half-spaces to which rays are
/// restricted. The reference is thus independent of how cells are cut.
struct UncutMesh {
  scene::TetMeshView mesh;
  std::span<const scene::HalfSpace> kept;  ///< of the data set's state; empty: the mesh is what is rendered
  scene::TetMeshView rendered;             ///< the mesh that is rendered; `mesh` if this rank has only a part
  std::shared_ptr<const void> owner;       ///< of `mesh`; null: the data set's state
};

}  // namespace tessera::frame
