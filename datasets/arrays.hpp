// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/tet_mesh.hpp"
#include "tessera/dataset.hpp"

/// Converts meshes to the arrays of the public API, and back.
namespace tessera::datasets {

/// The mesh's arrays, which own it.
MeshArrays arrays_of(scene::TetMesh mesh);

/// A copy of arrays in the layout of Dataset::mesh_arrays().
scene::TetMesh mesh_of(const MeshArrays& arrays);

}  // namespace tessera::datasets
