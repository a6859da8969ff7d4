// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "sorting/segment_lists.hpp"

namespace tessera::sorting {

/// Ray segments between rasterizer and pixels have one of two encodings. The code that does not depend on the number
/// format (tile renderer, sinks, mergers) is a template over an encoding, which declares:
///
///   Store  where segments wait, by pixel, until those that are final are taken
///   Depth  along the view direction; `end` is greater than all depths
///   Open   which pixels of a rectangle still accept segments
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

/// The same with an attribute in addition to the scalar (projection::ProjectedMesh::attribute). A type of its own keeps
/// the code compiled for DoubleEncoding as it is.
using AttributeEncoding = DoubleEncodingOf<projection::AttributeSegments>;

/// The integer lattice (scene/lattice.hpp): for frames that fit it, 16 pixels or cells at a time.
struct LatticeEncoding {
  using Store = projection::SegmentWindows;
  using Depth = std::int64_t;
  using Open = projection::OpenPixels;
  static constexpr Depth end = std::numeric_limits<std::int64_t>::max();
  static constexpr int square = projection::SegmentWindows::side;  ///< each rectangle is within one square of this side
};

}  // namespace tessera::sorting
