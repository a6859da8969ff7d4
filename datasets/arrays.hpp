// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

/// Converts meshes to the arrays of the public API, and back.
namespace tessera::datasets {

/// Converts a mesh to arrays, which own the mesh.
MeshArrays arrays_of(scene::TetMesh mesh);

/// Copies arrays in the layout of Dataset::mesh_arrays() to a mesh.
scene::TetMesh mesh_of(const MeshArrays& arrays);

}  // namespace tessera::datasets
