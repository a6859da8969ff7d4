// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tessera::readers {

/// One tree of cells. A cell is divided into branching^3, x first, or a leaf. Its cells are stored level by level, the
/// children of a level's first divided cell before those of its second.
struct StoredTree {
  std::int64_t root = 0;                  ///< its place among the grid's cells, as the file counts them
  std::size_t first = 0, cells = 0;       ///< whose values are its own, of those of all trees
  std::size_t first_bit = 0, bits = 0;    ///< in `divided`; cells after the last bit are leaves
  std::size_t first_mask = 0, masks = 0;  ///< in `masked`; cells after the last are not
};

/// What a HyperTreeGrid's file says of its trees.
struct StoredForest {
  std::array<std::int64_t, 3> roots{};  ///< cells of the grid along each axis, each of which a tree may divide
  int branching = 2;
  bool z_first = false;  ///< how roots are counted
  /// Values are stored in the order in which cells come to be if each is divided before its next sibling is.
  bool values_by_descent = false;
  std::vector<StoredTree> trees;
  std::vector<bool> divided, masked;
};

/// The cells at the trees' ends, those left out that are masked or part of a masked one.
struct ForestLeaves {
  int levels = 1;                    ///< the deepest leaf's level is the last
  std::vector<std::int32_t> lows;    ///< three a leaf: its lowest corner, in cells of the last level
  std::vector<std::uint8_t> level;   ///< of each leaf
  std::vector<std::int64_t> values;  ///< whose values each leaf has
  std::size_t masked = 0;            ///< that are left out, of those that the file tells apart
};

/// Throws Error(bad_input) where a tree does not have the cells that it promises, lies outside the grid or is too deep.
ForestLeaves leaves_of(const StoredForest& forest, const std::string& source);

}  // namespace tessera::readers
