// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera::readers {

/// One tree of cells. A cell is either divided into branching^3 cells, x fastest, or a leaf. Its cells are stored level
/// by level; the children of a level's first divided cell precede those of its second.
struct StoredTree {
  std::int64_t root = 0;                  ///< index of its root in the grid, as numbered in the file
  std::size_t first = 0, cells = 0;       ///< the range of its values among those of all trees
  std::size_t first_bit = 0, bits = 0;    ///< in `divided`; cells after the last bit are leaves
  std::size_t first_mask = 0, masks = 0;  ///< in `masked`; cells after the last mask are not masked
};

/// A HyperTreeGrid's trees as stored in its file.
struct StoredForest {
  std::array<std::int64_t, 3> roots{};  ///< cells of the grid along each axis, each of which may be the root of a tree
  int branching = 2;
  bool z_first = false;  ///< numbering of roots
  /// Values are stored in depth-first order: each cell is divided before its next sibling.
  bool values_by_descent = false;
  std::vector<StoredTree> trees;
  std::vector<bool> divided, masked;
};

/// The leaf cells of the trees without those that are masked or part of a masked cell.
struct ForestLeaves {
  int levels = 1;                    ///< the level of the deepest leaf is the last
  std::vector<std::int32_t> lows;    ///< three per leaf: its lowest corner, in cells of the last level
  std::vector<std::uint8_t> level;   ///< per leaf
  std::vector<std::int64_t> values;  ///< index of each leaf's value
  std::size_t masked = 0;            ///< number of masked cells left out, as far as the file identifies them
};

/// Throws Error(bad_input) if a tree does not have the number of cells that the file states, is outside the grid or is
/// too deep.
ForestLeaves leaves_of(const StoredForest& forest, const std::string& source);

}  // namespace tessera::readers
