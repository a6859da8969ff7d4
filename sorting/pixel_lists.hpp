// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/ray_segments.hpp"

namespace tessera::sorting {

/// The ray segments of a tile, listed pixel by pixel in visibility order.
///
/// The order is total, so it does not depend on the order in which the segments arrived. Segments are compared by
/// front, then back, then tet index; crossings of surfaces (projection/surface_crossings.hpp) are compared by their
/// number and their other fields before the tet index. With Key::back, which the `scanline` rasterizer uses, back
/// replaces front and back (z_back is the key in Juliachs et al. 2007, 4.3). Lists may have any length.
class PixelLists {
 public:
  enum class Key { front, back };

  /// Builds the lists of segments [0, segments.size) of a tile of `pixel_count` pixels. If segments arrive nearly in
  /// order (sorted by the nearest depth of their cells), each costs one comparison.
  void sort(const projection::RaySegments& segments, std::size_t pixel_count, Key key = Key::front);

  /// A segment in a list. The key is stored next to the index, so that comparing neighbours reads no other memory.
  struct Entry {
    double depth;           ///< sort key: front, or back with Key::back
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
