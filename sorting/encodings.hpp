// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "sorting/segment_lists.hpp"

namespace tessera::sorting {

/// Ray segments between the rasterizer and the pixels have one of two encodings. Code that does not depend on the
/// number format (tile renderer, sinks, mergers) is a template over an encoding, which declares:
///
///   Store  the container in which segments wait, sorted by pixel, until they are final and are taken
///   Depth  the type of a depth along the view direction; `end` is greater than all depths
///   Open   the type that marks the pixels of a rectangle which still accept segments
///
/// DoubleEncodingOf is the encoding in double precision, for any frame. Depths are in world units, scalars in the
/// field's own unit.
template <class Segments>
struct DoubleEncodingOf {
  using Store = SegmentListsOf<Segments>;
  using Depth = double;
  using Open = std::vector<std::uint8_t>;  ///< one value per pixel, row by row: 0 or 1
  static constexpr Depth end = std::numeric_limits<double>::infinity();
  static constexpr int square = 0;  ///< rectangles are whole tiles
};
using DoubleEncoding = DoubleEncodingOf<projection::RaySegments>;

/// The same encoding with an attribute in addition to the scalar (projection::ProjectedMesh::attribute). It is a
/// separate type, so that the code compiled for DoubleEncoding does not change.
using AttributeEncoding = DoubleEncodingOf<projection::AttributeSegments>;

/// The integer lattice (scene/lattice.hpp), for frames that have a lattice. It processes 16 pixels or cells at a time.
struct LatticeEncoding {
  using Store = projection::SegmentWindows;
  using Depth = std::int64_t;
  using Open = projection::OpenPixels;
  static constexpr Depth end = std::numeric_limits<std::int64_t>::max();
  static constexpr int square = projection::SegmentWindows::side;  ///< each rectangle is within one square of this side
};

}  // namespace tessera::sorting
