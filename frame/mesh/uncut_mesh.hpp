// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>

#include "scene/selection.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

namespace tessera::frame {

/// What a picture of a mesh is judged by: the mesh before it was clipped, and the half-spaces that rays are kept in. So
/// nothing that cells were cut by has a part in the reference.
struct UncutMesh {
  scene::TetMeshView mesh;
  std::span<const scene::HalfSpace> kept;  ///< of the data set's state; none: the mesh is what is rendered
  scene::TetMeshView rendered;             ///< the mesh as it is rendered; `mesh` where this rank has not all of it
  std::shared_ptr<const void> owner;       ///< of `mesh`; null: the data set's state
};

/// Of a data set that is whole on this rank, or was made of files, which may be read once more. Throws as
/// Dataset::open, and Error(bad_input) if this rank has only a part. The state must outlive it.
UncutMesh uncut_mesh(const Dataset::State& data);

/// Makes a grid's box that of what half-spaces leave of it. Throws Error(bad_input) if that is nothing.
void clip_box(Dataset::State& grid, const Selection& selection, const std::string& source);

}  // namespace tessera::frame
