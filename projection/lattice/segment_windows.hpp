// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "projection/large_array.hpp"

namespace tessera::projection {

/// A ray segment on the lattice: depths in steps, scalars in scalar steps as floats.
struct LatticeSegment {
  std::int32_t front, back;  ///< front <= back
  float scalar_front, scalar_back;
};
static_assert(sizeof(LatticeSegment) == 16);

/// The light on a segment's matter (projection/matter_light.hpp), which changes the segment's color c to own * c +
/// white * opacity.
struct SegmentLight {
  float own = 1, white = 0;
};

/// Segments as the rasterizer appends them: structure of arrays with `size` elements, in the order of the cells.
struct SegmentStream {
  /// Number of elements after the last one that a store of lanes may overwrite.
  static constexpr std::size_t padding = 64;

  std::size_t size = 0;
  std::vector<std::int32_t> front, back;
  std::vector<std::int32_t> pixel;  ///< row by row in the rectangle
  std::vector<float> scalar_front, scalar_back;
  /// If `lit` is set, `own` and `white` contain the SegmentLight of each segment.
  bool lit = false;
  std::vector<float> own, white;
  /// If `keeps_hits` is set (surfaces are crossed or matter is lit), `hit` contains, for the rasterizer's segments of
  /// the current batch of cells, the cell's number in the batch (low four bits), and column and row in the square.
  bool keeps_hits = false;
  std::vector<std::int32_t> hit;

  /// Allocates memory for `capacity` segments and the padding.
  void reserve(std::size_t capacity) {
    if (keeps_hits && hit.size() < capacity + padding) hit.resize(capacity + padding);
    if (lit && own.size() < capacity + padding) own.resize(capacity + padding), white.resize(capacity + padding);
    if (front.size() >= capacity + padding) return;
    for (auto* a : {&front, &back, &pixel}) a->resize(capacity + padding);
    for (auto* a : {&scalar_front, &scalar_back}) a->resize(capacity + padding);
  }
  [[nodiscard]] std::size_t bytes() const {
    return front.capacity() * 20 + hit.capacity() * 4 + own.capacity() * sizeof(SegmentLight);
  }
};

/// The memory of SegmentWindows.
struct WindowLists {
  std::size_t capacity, stride;
  LatticeSegment* segments;
  SegmentLight* lights;  ///< null: segments have no lights
  std::uint32_t* counts;
};

/// A short list of segments for each pixel of a rectangle, between rasterizer and compositor. The segments of a list
/// are in the order of arrival. When one list is full, the final segments of all lists are sorted, composited and
/// removed. Windows of 64 segments stay in the second-level cache and take a tenth of the time that sorting whole lists
/// takes.
class SegmentWindows {
 public:
  static constexpr int side = 32;                          ///< size of the square that contains a rectangle, in pixels
  static constexpr std::size_t most_pixels = side * side;  ///< most pixels of a rectangle
  static constexpr std::size_t pixel_padding = 16;         ///< number of empty lists after the last pixel's list

  /// Empties the lists and prepares one list for each of `pixels` pixels, with room for `capacity` segments. `lit`:
  /// each segment has a SegmentLight.
  void reset(std::size_t pixels, std::size_t capacity, bool lit = false);

  /// Doubles the capacity of every list; the lists keep their segments. Must not be called if bytes_after_growth()
  /// exceeds most_bytes.
  void grow();
  static constexpr std::size_t most_bytes = 0x7fffffff;  ///< positions in the lists are 32-bit integers
  [[nodiscard]] std::size_t bytes_after_growth() const {
    return (2 * capacity_ * stride() + pixel_padding) * (sizeof(LatticeSegment) + (lit_ ? sizeof(SegmentLight) : 0));
  }

  /// Distributes segments [from, stream.size) to the lists of their pixels. Stops before a segment whose list is full.
  /// Returns the index at which it stopped.
  std::size_t scatter(const SegmentStream& stream, std::size_t from);

  /// Appends one segment to a pixel's list; returns false if the list is full.
  bool push(std::size_t pixel, const LatticeSegment& segment, const SegmentLight& light = {}) {
    if (counts_[pixel] == capacity_) return false;
    const std::size_t at = counts_[pixel]++ * stride() + pixel;
    segments_[at] = segment;
    if (lit_) lights_[at] = light;
    return true;
  }
  /// Empties the lists.
  void clear() { counts_.assign(pixels_ + pixel_padding, 0); }

  [[nodiscard]] std::size_t pixels() const { return pixels_; }
  [[nodiscard]] std::size_t capacity() const { return capacity_; }
  /// Element k of pixel p's list is segments()[k * stride() + p]. The lists of neighbouring pixels grow at similar
  /// rates, so the elements that are written next are close together. Lanes may read (but not use) `pixel_padding`
  /// elements beyond the last one.
  [[nodiscard]] LatticeSegment* segments() { return segments_.data(); }
  /// The segments' lights, at the same indices; null: segments have no lights.
  [[nodiscard]] SegmentLight* lights() { return lit_ ? lights_.data() : nullptr; }
  /// The stride is not a power of two, because many lists of 64 segments, a power of two apart, would share few sets of
  /// a cache.
  [[nodiscard]] std::size_t stride() const { return pixels_ < 64 ? pixels_ : pixels_ + pixel_padding; }
  [[nodiscard]] std::uint32_t count(std::size_t pixel) const { return counts_[pixel]; }
  [[nodiscard]] std::uint32_t* counts() { return counts_.data(); }
  /// Number of segments in all lists.
  [[nodiscard]] std::uint64_t total() const {
    return std::accumulate(counts_.begin(), counts_.begin() + static_cast<std::ptrdiff_t>(pixels_), std::uint64_t{0});
  }
  [[nodiscard]] std::size_t bytes() const { return segments_.bytes() + (lit_ ? lights_.bytes() : 0); }

 private:
  void fit();

  std::size_t pixels_ = 0, capacity_ = 0;
  bool lit_ = false;
  LargeArray<LatticeSegment> segments_;
  LargeArray<SegmentLight> lights_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace tessera::projection
