// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// Counts, and with `drop` removes, cells whose tets have the same corner positions as those of an earlier cell, for
/// example if a part was merged several times. Duplicate cells would appear twice as dense as they are. Vertices are
/// kept, and original_cell keeps the cells' original numbers. Takes O(tets) time, and temporarily 8 bytes per vertex, 6
/// bytes per cell and 16 bytes per duplicate.
std::uint64_t find_duplicate_cells(scene::TetMesh& mesh, bool drop);

/// Only counts.
std::uint64_t count_duplicate_cells(const scene::TetMeshView& mesh);

/// A key for each cell of a part of a mesh, in any order, which depends only on the positions of its tets' corners:
/// cells of two parts with equal keys are duplicates, except for one pair in 2^64.
std::vector<std::uint64_t> duplicate_keys(const scene::TetMeshView& mesh);

/// Returns the number of keys that are equal to an earlier key. For the keys of all parts, this is the result of
/// find_duplicate_cells() for the whole mesh.
std::uint64_t count_repetitions(const std::vector<std::uint64_t>& keys);

}  // namespace tessera::cells
