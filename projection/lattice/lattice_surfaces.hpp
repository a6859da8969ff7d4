// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "projection/lattice/segment_windows.hpp"

namespace tessera::projection {

/// The iso-surfaces of a batch of cells on the lattice: computed from the cells by lattice_normals-inl.h, and used by
/// lattice_crossed-inl.h and lattice_cut-inl.h for the segments that the rasterizer has appended.
///
/// A segment's scalars have the bits of its neighbour's on their common face, and the surfaces' values are rounded in
/// the same way as those of vertices: so a ray crosses a surface in a face once. Where rounding could be visible,
/// because a surface almost coincides with a face, CellsAtSteps has both of the face's cells rasterized in double
/// precision, so they are not handled here.
struct LatticeSurfaces {
  static constexpr std::size_t most_cells = 16;
  /// Elements behind the last one of an array, which vectors of lanes may overwrite.
  static constexpr std::size_t padding = SegmentStream::padding;

  /// The values on the lattice between which a cell's surfaces are; for a cell without surfaces, a range that no
  /// segment can reach.
  alignas(64) float low[most_cells], high[most_cells];
  alignas(64) std::int32_t first[most_cells], count[most_cells];  ///< these, as indices of SurfaceSet::on_lattice()
  // Only for cells with crossed segments.
  alignas(64) double normal[3][most_cells];     ///< unit normal of the field; zero: none
  alignas(64) double least_cosine[most_cells];  ///< 1 without a normal, otherwise 0
  /// Orthographic: LatticeMark::cosine_code() of the normal and all rays.
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
