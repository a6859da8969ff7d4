#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

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

  /// Between which values on the lattice a cell's surfaces are; a cell without has none that a segment could reach.
  struct Limits {
    alignas(64) float low[most_cells], high[most_cells];
  };

  /// Which of the cells have surfaces, a bit each, but those of `without`. At most `most_cells` cells.
  std::uint32_t find(const LatticeView& view, std::span<const TileEntry> cells, std::uint32_t without);
  [[nodiscard]] const Limits& limits() const { return limits_; }

  /// Crosses segments of the stream, which are of the cells given to find() and have SegmentStream::hit. (x0, y0) is
  /// the square's first pixel.
  void cross(const LatticeView& view, std::span<const std::uint32_t> segments, int x0, int y0, SegmentStream& out);

  /// Room for the numbers of `count` segments and what a vector of lanes may write behind them.
  std::uint32_t* numbers(std::size_t count) {
    if (numbers_.size() < count + SegmentStream::padding) numbers_.resize(count + SegmentStream::padding);
    return numbers_.data();
  }

 private:
  void cross_segment(const IsoView& iso, std::size_t segment, const IsoView::Range& range, float cosine,
                     SegmentStream& out);

  std::array<IsoView::Range, most_cells> ranges_;
  std::array<glm::dvec3, most_cells> normals_;  ///< unit; zero: none
  std::array<double, most_cells> cosines_;      ///< orthographic: of all rays; perspective: where there is no normal
  Limits limits_;
  std::vector<std::uint32_t> numbers_;
};

}  // namespace tessera::projection
