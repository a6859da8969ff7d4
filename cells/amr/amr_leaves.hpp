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

/// Where the finest cells' corners lie. Corners of all levels are whole numbers on it, so that those at one place have
/// one position to the bit.
struct AmrLattice {
  glm::dvec3 origin{0}, spacing{1};

  /// Of trees: where the coarsest cells' corners lie along each axis, each `coarsest` steps from the next; between them
  /// steps are even. Empty of blocks, for which origin and spacing hold.
  std::array<std::vector<double>, 3> corners{};
  std::int32_t coarsest = 1;

  [[nodiscard]] bool is_even() const { return corners[0].empty(); }

  /// The coordinate along an axis; n need not be whole.
  [[nodiscard]] double position(std::size_t axis, double n) const {
    if (is_even()) return origin[static_cast<int>(axis)] + spacing[static_cast<int>(axis)] * n;
    const std::vector<double>& at = corners[axis];
    const double cell = std::clamp(std::floor(n / coarsest), 0.0, static_cast<double>(at.size() - 2));
    const auto c = static_cast<std::size_t>(cell);
    return std::lerp(at[c], at[c + 1], n / coarsest - cell);
  }
};

/// A cell that no finer one covers.
struct AmrLeaf {
  AmrIndex low;        ///< its lowest corner
  std::uint32_t cell;  ///< whose values it has, counted in its part
  std::uint32_t part;  ///< counted in `parts`
  std::int32_t level;  ///< deeper than its part's where finer cells cover a piece of that cell
};

/// The cells that are left of a mesh with levels of refinement, which lie side by side without overlap or gap. A cell
/// of a level and all the finer ones inside are a tree: level l + 1 divides a cell of level l, if at all, into n^3.
struct AmrLeaves {
  /// One block of the file.
  struct Part {
    std::string name;
    std::int32_t level = 0;
    AmrIndex low{};
    AmrIndex cells{};  ///< along each axis
  };
  AmrLattice lattice;
  std::vector<std::int32_t> size;  ///< of a level's cells on the lattice; the last is 1
  std::vector<Part> parts;
  std::vector<AmrLeaf> leaves;
  std::uint64_t covered = 0, hidden = 0;  ///< cells of the file that are not among them

  /// Whether a cell with these bits of vtkGhostType is not among them, and counts it then.
  bool leaves_out(std::uint8_t ghost);
};

/// Of cells of the finest level along an axis: two of them at the far end, and their halves, are numbers of 32 bits.
inline constexpr double most_amr_corners = 1 << 29;

/// The leaves of trees, each by its lowest corner on the part's own lattice and its level.
struct AmrTreeLeaves {
  std::vector<std::int32_t> lows;  ///< three each
  std::vector<std::uint8_t> levels;
};

/// A block of cells along the axes, or trees of them, as a file describes it.
struct AmrBlock {
  std::string name;                                                      ///< empty if it is the only one
  std::array<std::int64_t, 6> extent{};                                  ///< first and last point along each axis
  std::function<std::vector<std::uint8_t>(std::size_t cells)> ghosts{};  ///< bits of vtkGhostType, or empty

  // Of a block.
  bool is_image = false;
  std::array<double, 3> origin{}, spacing{};
  std::array<double, 9> direction{};

  // Of trees.
  int branching = 0, levels = 0;                                       ///< children along an axis; 0 levels: not trees
  std::function<std::vector<double>(std::size_t axis)> coordinates{};  ///< of the coarsest cells' corners; or empty
  std::function<std::optional<AmrTreeLeaves>()> leaves{};              ///< none: stored as other numbers
};

/// The leaves of blocks whose spacings tell their levels. Throws Error(bad_input) where levels do not nest.
AmrLeaves leaves_of_blocks(std::span<const AmrBlock> blocks, const std::string& source);

/// The leaves of trees, in one part or several, which have one grid of coarsest cells and divide no cell
/// of it twice. Cells that are ghosts are left out. Throws Error(bad_input) for others.
AmrLeaves leaves_of_trees(std::span<const AmrBlock> trees, const std::string& source);

}  // namespace tessera::cells
