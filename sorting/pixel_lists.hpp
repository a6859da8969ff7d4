// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/ray_segments.hpp"

namespace tessera::sorting {

/// The ray segments of a tile, listed pixel by pixel in visibility order.
///
/// The order is total, so it does not depend on the order in which the segments arrived. It is by front, then back,
/// then, for crossings of surfaces (projection/surface_crossings.hpp), their number and their other fields, then tet
/// index. In the mode of the `scanline` rasterizer, back replaces front and back (z_back is the key in Juliachs et al.
/// 2007, 4.3). Lists have any length.
class PixelLists {
 public:
  enum class Key { front, back };

  /// Lists segments [0, segments.size) of a tile of `pixel_count` pixels. Segments that arrive nearly in order (by
  /// their cells' nearest depth) cost one comparison each.
  void sort(const projection::RaySegments& segments, std::size_t pixel_count, Key key = Key::front);

  /// A segment in a list. The key is stored with the index: comparing neighbours then reads no other memory.
  struct Entry {
    double depth;           ///< front, or back with Key::back
    std::uint32_t segment;  ///< index into the segments passed to sort()
  };

  /// The pixel's segments in order along its ray.
  [[nodiscard]] std::span<const Entry> pixel(std::size_t pixel) const {
    return std::span(entries_).subspan(begin_[pixel], begin_[pixel + 1] - begin_[pixel]);
  }

  static constexpr std::size_t bytes_each = sizeof(Entry);  ///< per segment

 private:
  std::vector<std::uint32_t> begin_;
  std::vector<Entry> entries_;
};

}  // namespace tessera::sorting
