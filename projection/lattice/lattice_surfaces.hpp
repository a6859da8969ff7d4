// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "projection/lattice/segment_windows.hpp"

namespace tessera::projection {

/// The iso-surfaces of a batch of cells on the lattice: what lattice_normals-inl.h finds out about the cells,
/// lattice_crossed-inl.h and lattice_cut-inl.h ask of the segments that the rasterizer has appended.
///
/// A segment's scalars have the bits of its neighbour's on their common face, and the surfaces' values are rounded as
/// those of vertices are: so a ray crosses a surface in a face once. Where rounding could show, because a surface all
/// but coincides with a face, CellsAtSteps has both its cells rasterized in double precision, out of this one's reach.
struct LatticeSurfaces {
  static constexpr std::size_t most_cells = 16;
  /// Behind the last of an array, which vectors of lanes may overwrite.
  static constexpr std::size_t padding = SegmentStream::padding;

  /// Between which values on the lattice a cell's surfaces are; a cell without has none that a segment could reach.
  alignas(64) float low[most_cells], high[most_cells];
  alignas(64) std::int32_t first[most_cells], count[most_cells];  ///< those surfaces, of SurfaceSet::on_lattice()
  // Of cells with crossed segments alone.
  alignas(64) double normal[3][most_cells];     ///< the field's, unit; zero: none
  alignas(64) double least_cosine[most_cells];  ///< 1 where there is no normal, else 0
  /// Orthographic: LatticeMark::cosine_code() of all rays and the normal.
  alignas(64) std::int32_t cosine_code[most_cells];

  /// Room for the numbers of `segments` segments and the padding.
  std::int32_t* numbers(std::size_t segments) {
    if (numbers_.size() < segments + padding) numbers_.resize(segments + padding);
    return numbers_.data();
  }

 private:
  std::vector<std::int32_t> numbers_;
};

}  // namespace tessera::projection
