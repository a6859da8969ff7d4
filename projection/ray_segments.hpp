// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tessera::projection {

/// Ray segments of one tile: the intervals of its view rays inside tetrahedra.
///
/// Shape   structure of arrays of equal capacity; the first `size` elements are segments. capacity() excludes `padding`
///         elements after the last element, which a SIMD store may overwrite.
/// Order   unspecified. sorting/ orders the segments of a pixel by (front, back, tet).
/// Units   front, back: planar depth of entry and exit along the view direction, in world units. Depths are doubles, so
///         that the length of a thin cell far away has an error of 1e-16 of its depth. Scalars at entry and exit are in
///         the field's own unit.
/// Holds   front <= back, both inside the clipping range, all finite. Cells thinner than the rounding of a depth have
///         length zero; they are kept, so that the set of cells that a ray passes is exact.
struct RaySegments {
  static constexpr std::size_t padding = 16;

  std::size_t size = 0;
  std::vector<std::uint64_t> pixel_and_tet;  ///< low half: row-major pixel in the tile; high half: tet index
  std::vector<double> front, back, scalar_front, scalar_back;

  static constexpr std::size_t bytes_each = sizeof(std::uint64_t) + 4 * sizeof(double);

  void reserve(std::size_t capacity) {
    for (std::vector<double>* array : {&front, &back, &scalar_front, &scalar_back}) array->resize(capacity + padding);
    pixel_and_tet.resize(capacity + padding);
  }
  [[nodiscard]] std::size_t capacity() const { return front.size() < padding ? 0 : front.size() - padding; }
  [[nodiscard]] std::uint32_t pixel(std::size_t i) const { return static_cast<std::uint32_t>(pixel_and_tet[i]); }
  [[nodiscard]] std::uint32_t tet(std::size_t i) const { return static_cast<std::uint32_t>(pixel_and_tet[i] >> 32); }

  /// Moves segment `from` to `to`, which must not be greater.
  void move(std::size_t from, std::size_t to) {
    pixel_and_tet[to] = pixel_and_tet[from];
    front[to] = front[from];
    back[to] = back[from];
    scalar_front[to] = scalar_front[from];
    scalar_back[to] = scalar_back[from];
  }
};

/// Ray segments with a second value in addition to the scalar. This attribute is linear in each cell; an example is the
/// light that reaches the cell. It is a separate type, so that rasterizer, store and sinks compiled for RaySegments are
/// not affected.
struct AttributeSegments : RaySegments {
  std::vector<double> attribute_front, attribute_back;  ///< at entry and exit, in the attribute's own unit

  static constexpr std::size_t bytes_each = RaySegments::bytes_each + 2 * sizeof(double);

  void reserve(std::size_t capacity) {
    RaySegments::reserve(capacity);
    for (std::vector<double>* array : {&attribute_front, &attribute_back}) array->resize(capacity + padding);
  }
  void move(std::size_t from, std::size_t to) {
    RaySegments::move(from, to);
    attribute_front[to] = attribute_front[from];
    attribute_back[to] = attribute_back[from];
  }
};

}  // namespace tessera::projection
