#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "projection/lattice_rasterizer.hpp"

namespace tessera::projection {

/// The iso-surfaces of a batch of cells on the lattice: cuts the segments that the rasterizer has appended where they
/// cross one, and appends what is behind and the crossing itself (surface_crossings.hpp).
///
/// A segment's scalars have the bits of its neighbour's on their common face, and the surfaces' values are rounded as
/// those of vertices are: so a ray crosses a surface in a face once. Where rounding could show, because a surface all
/// but coincides with a face, CellsAtSteps has both its cells rasterized in double precision, out of this one's reach.
class LatticeSurfaces {
 public:
  static constexpr std::size_t most_cells = 16;

  /// Which of the cells have surfaces, a bit each. At most `most_cells` cells.
  std::uint32_t find(const LatticeView& view, std::span<const TileEntry> cells);

  /// Of the stream's segments from `first` on, which are of these cells and have SegmentStream::hit. `cells` are those
  /// given to find(), `crossed` its answer; (x0, y0) is the square's first pixel.
  void cross(const LatticeView& view, std::span<const TileEntry> cells, std::uint32_t crossed, std::size_t first,
             int x0, int y0, SegmentStream& out);

 private:
  void cross_segment(const IsoView& iso, std::size_t segment, const IsoView::Range& range, const glm::dvec3& ray,
                     const glm::dvec3& normal, SegmentStream& out);

  std::array<IsoView::Range, most_cells> ranges_;
  std::array<glm::dvec3, most_cells> normals_;
};

}  // namespace tessera::projection
