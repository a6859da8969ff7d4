// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::frame {

/// The reference for images of a clipped mesh: the mesh before it was clipped, and the half-spaces to which rays are
/// restricted. So the reference does not depend on how cells are cut.
struct UncutMesh {
  scene::TetMeshView mesh;
  /// The half-spaces by which the data set was clipped; empty: it was not clipped.
  std::span<const scene::HalfSpace> kept;
  scene::TetMeshView rendered;        ///< the mesh that is rendered; `mesh` if this rank has only a part
  std::shared_ptr<const void> owner;  ///< keeps `mesh` in memory; null: the data set's state does
};

}  // namespace tessera::frame
