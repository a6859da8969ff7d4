// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

/// Meshes as the public API has them, and back.
namespace tessera::datasets {

/// The mesh's arrays, which keep it.
MeshArrays arrays_of(scene::TetMesh mesh);

/// A copy of arrays laid out as Dataset::mesh_arrays() gives them.
scene::TetMesh mesh_of(const MeshArrays& arrays);

}  // namespace tessera::datasets
