// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "sorting/segment_lists.hpp"

namespace tessera::sorting {

/// Ray segments on their way from a rasterizer into pixels are written in one of two encodings. What does not depend on
/// numbers (tile renderer, sinks, mergers) is one source over both, with these names:
///
///   Store  where segments wait, by pixel, until what is final of them is taken
///   Depth  along the view direction; `end` lies behind all
///   Open   which pixels of a rectangle still take anything
///
/// Double precision: any frame. Depths in world units, scalars in the field's own.
template <class Segments>
struct DoubleEncodingOf {
  using Store = SegmentListsOf<Segments>;
  using Depth = double;
  using Open = std::vector<std::uint8_t>;  ///< by pixel, row by row: 0 or 1
  static constexpr Depth end = std::numeric_limits<double>::infinity();
  static constexpr int square = 0;  ///< rectangles are whole tiles
};
using DoubleEncoding = DoubleEncodingOf<projection::RaySegments>;

/// The same with an attribute beside the scalar (projection::ProjectedMesh::attribute). What is compiled for
/// DoubleEncoding does not change by it.
using AttributeEncoding = DoubleEncodingOf<projection::AttributeSegments>;

/// The integer lattice (scene/lattice.hpp): frames that fit it, 16 pixels or cells at a time.
struct LatticeEncoding {
  using Store = projection::SegmentWindows;
  using Depth = std::int64_t;
  using Open = projection::OpenPixels;
  static constexpr Depth end = std::numeric_limits<std::int64_t>::max();
  static constexpr int square = projection::SegmentWindows::side;  ///< rectangles lie in squares of this side
};

}  // namespace tessera::sorting
