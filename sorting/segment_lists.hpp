// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "projection/ray_segments.hpp"
#include "sorting/pixel_lists.hpp"

namespace tessera::sorting {

/// The ray segments of a rectangle's pixels in double precision, in the order in which a rasterizer appends them,
/// together with their lists in visibility order, one list per pixel. On the integer lattice,
/// projection::SegmentWindows has this role. `Segments`: projection::RaySegments or AttributeSegments.
template <class Segments>
class SegmentListsOf {
 public:
  using Key = PixelLists::Key;
  static constexpr std::size_t bytes_each = Segments::bytes_each + PixelLists::bytes_each;

  /// Empties the lists and prepares one list for each of `pixels` pixels, ordered by `key`. Keeps the allocated memory.
  void reset(std::size_t pixels, Key key = Key::front) {
    pixels_ = pixels;
    key_ = key;
    segments.size = 0;
  }

  /// Rasterizers append segments here; the caller ensures that there is enough room.
  Segments segments;

  /// Builds the lists of the segments that are in `segments` now.
  void sort() { lists_.sort(segments, pixels_, key_); }
  [[nodiscard]] std::span<const PixelLists::Entry> pixel(std::size_t p) const { return lists_.pixel(p); }
  [[nodiscard]] std::size_t pixels() const { return pixels_; }

  /// Removes segments whose key is less than `final_depth`, and those of pixels p with open[p] == 0 (if `open` is
  /// empty, all pixels are open); the other segments keep their order. Returns the number of removed segments. Does not
  /// update the lists.
  std::size_t remove(double final_depth, std::span<const std::uint8_t> open);

 private:
  std::size_t pixels_ = 0;
  Key key_ = Key::front;
  PixelLists lists_;
};

using SegmentLists = SegmentListsOf<projection::RaySegments>;
extern template class SegmentListsOf<projection::RaySegments>;
extern template class SegmentListsOf<projection::AttributeSegments>;

}  // namespace tessera::sorting
