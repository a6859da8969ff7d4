// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "projection/lattice/segment_windows.hpp"

namespace tessera::projection {

/// The iso-surfaces of a batch of cells on the lattice. lattice_normals-inl.h computes them from the cells;
/// lattice_crossed-inl.h and lattice_cut-inl.h use them for the segments that the rasterizer has appended.
///
/// On a common face, the scalars of a segment and of its neighbour have the same bits, and the surfaces' values are
/// rounded in the same way as those of vertices. So a ray crosses a surface in a face exactly once. If rounding could
/// be visible because a surface almost coincides with a face, CellsAtSteps makes both cells of the face irregular. They
/// are rasterized in double precision and not handled here.
struct LatticeSurfaces {
  static constexpr std::size_t most_cells = 16;
  /// Elements after the last element of an array that vectors of lanes may overwrite.
  static constexpr std::size_t padding = SegmentStream::padding;

  /// The range of the values, on the lattice, of a cell's surfaces; for a cell without surfaces, a range that no
  /// segment can reach.
  alignas(64) float low[most_cells], high[most_cells];
  /// The cell's surfaces, as indices of SurfaceSet::on_lattice().
  alignas(64) std::int32_t first[most_cells], count[most_cells];
  // The following are only set for cells with crossed segments.
  alignas(64) double normal[3][most_cells];     ///< unit normal of the field; zero: there is no normal
  alignas(64) double least_cosine[most_cells];  ///< 1 without a normal, otherwise 0
  /// Orthographic: LatticeMark::cosine_code() for the normal and all rays.
  alignas(64) std::int32_t cosine_code[most_cells];

  /// Returns memory for the indices of `segments` segments, and the padding.
  std::int32_t* numbers(std::size_t segments) {
    if (numbers_.size() < segments + padding) numbers_.resize(segments + padding);
    return numbers_.data();
  }

 private:
  std::vector<std::int32_t> numbers_;
};

}  // namespace tessera::projection
