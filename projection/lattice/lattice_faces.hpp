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
/// ray have different steps, in the order of FaceMarks, so a mark is at most as many steps from its depth as the ray
/// has marks nearby.
///
/// A mark becomes a segment of length zero (surface_crossings.hpp), and the rasterizer's segments are cut there
/// (lattice_faces-inl.h). Segments in front of a mark end at its step and segments behind it begin there: the order of
/// segments, by front and then by back, puts the mark between them. Marks of one step are in the order of their
/// numbers.
class LatticeFaces {
 public:
  /// The largest error of the depth of a cell's face, in steps, with one step for the rounding of a mark: 17 for
  /// planes; perspective divides in floats, which adds 3.2e-7 of the depth of the cell.
  static std::int32_t face_error(bool perspective) { return perspective ? 18 + 344 : 18; }

  /// Takes the sorted marks of a rectangle. `steps` are those of the transfer function.
  void set(const FaceMarks& marks, const scene::Lattice& lattice, bool perspective, std::span<const Step> steps);

  [[nodiscard]] bool empty() const { return place_.empty(); }
  /// The marks of pixel p have the indices [begin()[p], begin()[p + 1]).
  [[nodiscard]] const std::int32_t* begin() const { return begin_.data(); }
  /// Each mark's depth, in steps; ascending along a ray.
  [[nodiscard]] const std::int32_t* places() const { return place_.data(); }
  /// The largest distance, in steps, of a face of a cell from a mark in the same plane.
  [[nodiscard]] const std::int32_t* reaches() const { return reach_.data(); }
  [[nodiscard]] std::int32_t most_reach() const { return most_reach_; }
  /// Each mark's number (FaceMark).
  [[nodiscard]] const std::int32_t* numbers() const { return number_.data(); }

  /// Appends the marks that this process owns. SegmentStream::lit must be set.
  void append_own(SegmentStream& out) const;

 private:
  struct Own {
    std::int32_t pixel, place;
    float mark, scalar;
  };
  std::vector<std::int32_t> begin_, place_, reach_, number_;
  std::int32_t most_reach_ = 0;
  std::vector<Own> own_;
};

}  // namespace tessera::projection
