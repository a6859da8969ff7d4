// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "projection/face_marks.hpp"
#include "projection/lattice/segment_windows.hpp"
#include "projection/steps.hpp"
#include "scene/lattice.hpp"

namespace tessera::projection {

/// The points where the rays of a rectangle meet triangle surfaces, with depths in steps of the lattice. Marks of one
/// ray at one step are sorted by their numbers, as segments are; if FaceMarks has another order for these marks, the
/// later marks are moved to the next step.
///
/// A mark becomes a segment of length zero (surface_crossings.hpp), and the rasterizer's segments are cut at the mark
/// (lattice_faces-inl.h). Segments in front of a mark end at its step and segments behind it begin at its step: the
/// order of segments, by front and then by back, puts the mark between them.
class LatticeFaces {
 public:
  /// If a mark is within this number of steps behind a segment's front, or before its back, the front or back is moved
  /// to the mark: depths of planes have errors of up to 16 steps, and depths of marks have errors of up to one step.
  /// (Perspective divides in floats, whose larger errors DepthLimits bounds.)
  static constexpr std::int32_t reach = 18;

  /// Takes the sorted marks of a rectangle. `steps` are those of the transfer function.
  void set(const FaceMarks& marks, const scene::Lattice& lattice, std::span<const Step> steps);

  [[nodiscard]] bool empty() const { return place_.empty(); }
  /// The marks of pixel p have the indices [begin()[p], begin()[p + 1]).
  [[nodiscard]] const std::int32_t* begin() const { return begin_.data(); }
  /// Each mark's depth, in steps; ascending along a ray.
  [[nodiscard]] const std::int32_t* places() const { return place_.data(); }

  /// Appends the marks that this process owns. SegmentStream::lit must be set.
  void append_own(SegmentStream& out) const;

 private:
  struct Own {
    std::int32_t pixel, place;
    float mark, scalar;
  };
  std::vector<std::int32_t> begin_, place_;
  std::vector<Own> own_;
};

}  // namespace tessera::projection
