// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera::readers {

/// One tree of cells. A cell is either divided into branching^3 cells, x fastest, or a leaf. Cells are stored level by
/// level: the children of the first divided cell of a level precede those of the second.
struct StoredTree {
  std::int64_t root = 0;                  ///< index of the root cell in the grid, in the file's numbering
  std::size_t first = 0, cells = 0;       ///< range of the tree's values among those of all trees
  std::size_t first_bit = 0, bits = 0;    ///< the tree's bits in `divided`; cells after the last bit are leaves
  std::size_t first_mask = 0, masks = 0;  ///< range of the tree's bits in `masked`; cells after the last are not masked
};

/// The trees of a HyperTreeGrid as stored in the file.
struct StoredForest {
  std::array<std::int64_t, 3> roots{};  ///< number of cells of the grid along each axis; each may be the root of a tree
  int branching = 2;
  bool z_first = false;  ///< roots are numbered with z fastest
  /// Values are stored in depth-first order: all descendants of a cell precede its next sibling.
  bool values_by_descent = false;
  std::vector<StoredTree> trees;
  std::vector<bool> divided, masked;
};

/// The leaf cells of the trees, without leaves that are masked or inside a masked cell.
struct ForestLeaves {
  int levels = 1;                    ///< number of levels down to the deepest leaf
  std::vector<std::int32_t> lows;    ///< three numbers per leaf: its lowest corner, in units of the last level's cells
  std::vector<std::uint8_t> level;   ///< per leaf
  std::vector<std::int64_t> values;  ///< index of the value of each leaf
  std::size_t masked = 0;            ///< number of masked cells that were left out, as far as the file contains it
};

/// Returns the leaves. Throws Error(bad_input) if a tree is outside the grid or too deep, or does not have the number
/// of cells that the file states.
ForestLeaves leaves_of(const StoredForest& forest, const std::string& source);

}  // namespace tessera::readers
