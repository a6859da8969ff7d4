#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "io/foreign_file.hpp"

namespace tessera::io {

/// A corner on the lattice of the finest cells.
using AmrIndex = std::array<std::int32_t, 3>;

/// Where the finest cells' corners lie. Corners of all levels are whole numbers on it, so that those at one place have
/// one position to the bit.
struct AmrLattice {
  glm::dvec3 origin{0}, spacing{1};

  /// The coordinate along an axis; n need not be whole.
  [[nodiscard]] double position(std::size_t axis, double n) const {
    return origin[static_cast<int>(axis)] + spacing[static_cast<int>(axis)] * n;
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
    const ForeignFile* file;
    const ForeignPart* part;
    std::int32_t level = 0;
    AmrIndex low{};
    AmrIndex cells{};  ///< along each axis
  };
  AmrLattice lattice;
  std::vector<std::int32_t> size;  ///< of a level's cells on the lattice; the last is 1
  std::vector<Part> parts;
  std::vector<AmrLeaf> leaves;
  std::uint64_t covered = 0, hidden = 0;  ///< cells of the file that are not among them
};

/// An image (kind image of foreign_data.hpp) of cells.
struct AmrBlock {
  const ForeignFile* file;
  const ForeignPart* part;
};

/// The leaves of blocks whose spacings tell their levels. Throws Error(bad_input) where levels do not nest.
AmrLeaves leaves_of_blocks(std::span<const AmrBlock> blocks, const std::string& source);

}  // namespace tessera::io
