// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "projection/large_array.hpp"

namespace tessera::projection {

/// A ray segment on the lattice: depths in its steps, scalars in its scalar steps as floats.
struct LatticeSegment {
  std::int32_t front, back;  ///< front <= back
  float scalar_front, scalar_back;
};
static_assert(sizeof(LatticeSegment) == 16);

/// Segments as the rasterizer appends them: structure of arrays, `size` of them, in the order of the cells.
struct SegmentStream {
  static constexpr std::size_t padding = 64;  ///< elements that a store of lanes may overwrite behind the last

  std::size_t size = 0;
  std::vector<std::int32_t> front, back;
  std::vector<std::int32_t> pixel;  ///< row by row in the rectangle
  std::vector<float> scalar_front, scalar_back;
  /// Where surfaces are crossed, of the rasterizer's own while it is at a batch of cells: which cell of it (low four
  /// bits) and which column and row of the square.
  bool keeps_hits = false;
  std::vector<std::int32_t> hit;

  /// Room for `capacity` segments and the padding.
  void reserve(std::size_t capacity) {
    if (keeps_hits && hit.size() < capacity + padding) hit.resize(capacity + padding);
    if (front.size() >= capacity + padding) return;
    for (auto* a : {&front, &back, &pixel}) a->resize(capacity + padding);
    for (auto* a : {&scalar_front, &scalar_back}) a->resize(capacity + padding);
  }
  [[nodiscard]] std::size_t bytes() const { return front.capacity() * 20 + hit.capacity() * 4; }
};

/// A short list of segments for each pixel of a rectangle: what is in flight between rasterizer and compositor. Lists
/// are in order of arrival; when one is full, what is final in all of them is sorted, composited and removed. Windows
/// of 64 segments stay in the second-level cache and cost a tenth of sorting whole lists.
class SegmentWindows {
 public:
  static constexpr int side = 32;                          ///< of the square that rectangles lie in, pixels
  static constexpr std::size_t most_pixels = side * side;  ///< of a rectangle
  static constexpr std::size_t pixel_padding = 16;         ///< lists behind the last pixel's, empty

  /// Empties the lists: one for each of `pixels` pixels, with room for `capacity` segments.
  void reset(std::size_t pixels, std::size_t capacity);

  /// Doubles the room of every list; what is in them stays. Not beyond most_bytes.
  void grow();
  static constexpr std::size_t most_bytes = 0x7fffffff;  ///< a 32-bit number says where in the lists a segment is
  [[nodiscard]] std::size_t bytes_after_growth() const {
    return (2 * capacity_ * stride() + pixel_padding) * sizeof(LatticeSegment);
  }

  /// Scatters segments [from, stream.size) to their pixels' lists; stops before one whose list is full. Returns where
  /// it stopped.
  std::size_t scatter(const SegmentStream& stream, std::size_t from);

  /// Appends one segment to a pixel's list; false if that is full.
  bool push(std::size_t pixel, const LatticeSegment& segment) {
    if (counts_[pixel] == capacity_) return false;
    segments_[counts_[pixel]++ * stride() + pixel] = segment;
    return true;
  }
  /// Empties the lists.
  void clear() { counts_.assign(pixels_ + pixel_padding, 0); }

  [[nodiscard]] std::size_t pixels() const { return pixels_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  /// Element k of pixel p's list is segments()[k * stride() + p]: neighbours' lists grow alike, so what is written to
  /// lies together. Lanes may read (but not use) `pixel_padding` elements beyond the last.
  [[nodiscard]] LatticeSegment* segments() { return segments_.data(); }
  /// Many lists of 64 segments a power of two apart would crowd into few sets of a cache.
  [[nodiscard]] std::size_t stride() const { return pixels_ < 64 ? pixels_ : pixels_ + pixel_padding; }
  [[nodiscard]] std::uint32_t count(std::size_t pixel) const { return counts_[pixel]; }
  [[nodiscard]] std::uint32_t* counts() { return counts_.data(); }
  /// Segments in all lists.
  [[nodiscard]] std::uint64_t total() const {
    return std::accumulate(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(pixels_), std::uint64_t{0});
  }
  [[nodiscard]] std::size_t bytes() const { return segments_.bytes(); }

 private:
  void fit();

  std::size_t pixels_ = 0, capacity_ = 0;
  LargeArray<LatticeSegment> segments_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace tessera::projection
