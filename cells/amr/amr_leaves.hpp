// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tessera::cells {

/// A corner on the lattice of the finest cells.
using AmrIndex = std::array<std::int32_t, 3>;

/// Positions of the corners of the finest cells. Corners of all levels have integer coordinates on this lattice, so
/// that coincident corners have exactly equal positions.
struct AmrLattice {
  glm::dvec3 origin{0}, spacing{1};

  /// For trees: the positions of the coarsest cells' corners along each axis. They are `coarsest` steps of the lattice
  /// apart, and the steps between two of them are uniform. Empty for blocks, which use origin and spacing.
  std::array<std::vector<double>, 3> corners{};
  std::int32_t coarsest = 1;

  [[nodiscard]] bool is_even() const { return corners[0].empty(); }

  /// Returns the coordinate of index n along an axis; n need not be an integer.
  [[nodiscard]] double position(std::size_t axis, double n) const {
    if (is_even()) return origin[static_cast<int>(axis)] + spacing[static_cast<int>(axis)] * n;
    const std::vector<double>& at = corners[axis];
    const double cell = std::clamp(std::floor(n / coarsest), 0.0, static_cast<double>(at.size() - 2));
    const auto c = static_cast<std::size_t>(cell);
    return std::lerp(at[c], at[c + 1], n / coarsest - cell);
  }
};

/// A cell that no finer cell covers.
struct AmrLeaf {
  AmrIndex low;        ///< lowest corner of the leaf
  std::uint32_t cell;  ///< index, in the part, of the cell that supplies the value
  std::uint32_t part;  ///< index in `parts`
  std::int32_t level;  ///< finer than the level of `cell` if finer cells cover a part of that cell
};

/// The cells of a mesh with refinement levels, except cells that finer cells cover. The leaves are adjacent without
/// overlap or gap. A cell and all finer cells inside it form a tree: level l + 1 divides a cell of level l either not
/// at all or into n^3 cells.
struct AmrLeaves {
  /// One block of the file.
  struct Part {
    std::string name;
    std::int32_t level = 0;
    AmrIndex low{};
    AmrIndex cells{};  ///< number of cells along each axis
  };
  AmrLattice lattice;
  std::vector<std::int32_t> size;  ///< size on the lattice of each level's cells; the last is 1
  std::vector<Part> parts;
  std::vector<AmrLeaf> leaves;
  std::uint64_t covered = 0, hidden = 0;  ///< cells of the file that are left out

  /// Whether a cell with these bits of vtkGhostType is left out. Counts cells that are left out.
  bool leaves_out(std::uint8_t ghost);
};

/// Limit of the number of cells of the finest level along an axis: twice that number, and halves of these cells, must
/// fit into 32 bits.
inline constexpr double most_amr_corners = 1 << 29;

/// The leaves of trees. Each has a level, and a lowest corner on the part's own lattice.
struct AmrTreeLeaves {
  std::vector<std::int32_t> lows;  ///< three numbers per leaf
  std::vector<std::uint8_t> levels;
};

/// A block of axis-aligned cells, or a part with trees of cells, as described by a file.
struct AmrBlock {
  std::string name;                                                      ///< empty if the file has only one block
  std::array<std::int64_t, 6> extent{};                                  ///< first and last point index along each axis
  std::function<std::vector<std::uint8_t>(std::size_t cells)> ghosts{};  ///< returns bits of vtkGhostType, or nothing

  // For blocks:
  bool is_image = false;
  std::array<double, 3> origin{}, spacing{};
  std::array<double, 9> direction{};

  // For trees:
  int branching = 0, levels = 0;                                       ///< `branching`: children of a cell along each
                                                                       ///< axis; 0 levels: no trees
  std::function<std::vector<double>(std::size_t axis)> coordinates{};  ///< returns the coarsest cells' corners, or
                                                                       ///< nothing
  std::function<std::optional<AmrTreeLeaves>()> leaves{};              ///< no value: unexpected types of numbers
};

/// Finds the leaves of blocks, whose spacings determine their levels. Throws Error(bad_input) if levels do not nest.
AmrLeaves leaves_of_blocks(std::span<const AmrBlock> blocks, const std::string& source);

/// Finds the leaves of trees, in one part or several. The parts must have the same grid of coarsest cells, and no two
/// of them may divide the same cell of that grid; otherwise throws Error(bad_input). Ghost cells are left out.
AmrLeaves leaves_of_trees(std::span<const AmrBlock> trees, const std::string& source);

}  // namespace tessera::cells
