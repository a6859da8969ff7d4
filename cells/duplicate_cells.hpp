// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::cells {

/// Counts, and with `drop` removes, cells whose tets have the corners of an earlier cell's by position: parts that were
/// put together several times. Each of them is drawn twice as dense as it is. Vertices stay, and original_cell has the
/// cells' numbers as they were. Takes O(tets) time, and for its duration 8 bytes a vertex and 6 a cell; 16 more for
/// each duplicate.
std::uint64_t find_duplicate_cells(scene::TetMesh& mesh, bool drop, int threads);

/// The count alone.
std::uint64_t count_duplicate_cells(const scene::TetMeshView& mesh, int threads);

/// A number for each cell of a part of a mesh, in any order, which depends on the positions of its tets' corners alone:
/// cells of two parts with the same one are duplicates, but for one pair of 2^64.
std::vector<std::uint64_t> duplicate_keys(const scene::TetMeshView& mesh, int threads);

/// How many of the keys are equal to an earlier one: of the keys of all parts, what find_duplicate_cells() returns for
/// the whole mesh.
std::uint64_t count_repetitions(const std::vector<std::uint64_t>& keys, int threads);

}  // namespace tessera::cells
