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

/// Positions of the finest cells' corners. Corners of all levels have integer coordinates, so that coincident corners
/// have exactly equal positions.
struct AmrLattice {
  glm::dvec3 origin{0}, spacing{1};

  /// For trees: the positions of the coarsest cells' corners along each axis, `coarsest` steps apart, with uniform
  /// steps between them. Empty for blocks, which use origin and spacing.
  std::array<std::vector<double>, 3> corners{};
  std::int32_t coarsest = 1;

  [[nodiscard]] bool is_even() const { return corners[0].empty(); }

  /// The coordinate along an axis; n need not be an integer.
  [[nodiscard]] double position(std::size_t axis, double n) const {
    if (is_even()) return origin[static_cast<int>(axis)] + spacing[static_cast<int>(axis)] * n;
    const std::vector<double>& at = corners[axis];
    const double cell = std::clamp(std::floor(n / coarsest), 0.0, static_cast<double>(at.size() - 2));
    const auto c = static_cast<std::size_t>(cell);
    return std::lerp(at[c], at[c + 1], n / coarsest - cell);
  }
};

/// A cell that is not covered by a finer one.
struct AmrLeaf {
  AmrIndex low;        ///< its lowest corner
  std::uint32_t cell;  ///< index, in its part, of the cell whose value it has
  std::uint32_t part;  ///< index in `parts`
  std::int32_t level;  ///< finer than that cell's level if finer cells cover a part of it
};

/// The remaining cells of a mesh with refinement levels, which are adjacent without overlap or gap. A cell of a level
/// and all finer ones inside form a tree: level l + 1 divides a cell of level l, if at all, into n^3 cells.
struct AmrLeaves {
  /// One block of the file.
  struct Part {
    std::string name;
    std::int32_t level = 0;
    AmrIndex low{};
    AmrIndex cells{};  ///< along each axis
  };
  AmrLattice lattice;
  std::vector<std::int32_t> size;  ///< size of each level's cells on the lattice; the last is 1
  std::vector<Part> parts;
  std::vector<AmrLeaf> leaves;
  std::uint64_t covered = 0, hidden = 0;  ///< cells of the file that are left out

  /// Whether a cell with these bits of vtkGhostType is left out; counts it if so.
  bool leaves_out(std::uint8_t ghost);
};

/// Limit of cells of the finest level along an axis: twice that many, and halves of them, must fit into 32 bits.
inline constexpr double most_amr_corners = 1 << 29;

/// The leaves of trees, each given by its level and its lowest corner on the part's own lattice.
struct AmrTreeLeaves {
  std::vector<std::int32_t> lows;  ///< three numbers per leaf
  std::vector<std::uint8_t> levels;
};

/// A block of axis-aligned cells, or trees of them, as described by a file.
struct AmrBlock {
  std::string name;                                                      ///< empty if it is the only one
  std::array<std::int64_t, 6> extent{};                                  ///< first and last point index along each axis
  std::function<std::vector<std::uint8_t>(std::size_t cells)> ghosts{};  ///< bits of vtkGhostType, or empty

  // For blocks:
  bool is_image = false;
  std::array<double, 3> origin{}, spacing{};
  std::array<double, 9> direction{};

  // For trees:
  int branching = 0, levels = 0;                                       ///< children along an axis; 0 levels: no trees
  std::function<std::vector<double>(std::size_t axis)> coordinates{};  ///< of the coarsest cells' corners; or empty
  std::function<std::optional<AmrTreeLeaves>()> leaves{};              ///< no value: stored as another number type
};

/// The leaves of blocks, whose spacings determine their levels. Throws Error(bad_input) if levels do not nest.
AmrLeaves leaves_of_blocks(std::span<const AmrBlock> blocks, const std::string& source);

/// The leaves of trees, in one part or several, which share one grid of coarsest cells and divide no cell of it twice.
/// Ghost cells are left out. Throws Error(bad_input) for other trees.
AmrLeaves leaves_of_trees(std::span<const AmrBlock> trees, const std::string& source);

}  // namespace tessera::cells
