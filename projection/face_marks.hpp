// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "projection/ray_segments.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::projection {

/// The point where a ray meets a triangle of a surface.
struct FaceMark {
  std::uint32_t pixel;   ///< row-major in the rectangle
  std::uint32_t number;  ///< scene::SurfaceSet::face_crossing()
  double depth, value;   ///< planar depth, and the field's value at the point; the value is 0 if there is no field
  double tolerance;      ///< largest rounding error of the depth
  std::array<double, 2> slope, slope_error;  ///< change of the depth from one pixel to the next, in x and in y
  float cosine;                              ///< cosine of the angle between ray and normal
  bool own;  ///< whether this process owns the triangle; for other processes' marks, only the depth is needed
  double place = 0, behind = 0;  ///< set by FaceMarks::sort()
};

/// The triangles that the rays of a rectangle meet, and their effect on the ray segments of its pixels, in double
/// precision.
///
/// A mark becomes a crossing among the segments (surface_crossings.hpp); the one process that owns the triangle inserts
/// it. Every process cuts its own segments at the mark, so that in depth order the crossing is between the parts of a
/// segment.
///
/// Marks of a ray whose depths differ by no more than their tolerances are treated as one depth, for example where the
/// ray passes through an edge or a corner. The order of these marks is that in which the ray, shifted as in
/// edge_sign(), meets their planes: by slope in x, then in y. Marks in one plane are in the order of their numbers
/// (scene::SurfaceSet). This order is encoded in the depths, which every exchange preserves, in units in the last place
/// of a double:
///   - segments that end at the marks end at the depth itself;
///   - the marks follow, two units apart, and segments behind the marks begin two units behind the last mark;
///   - a crossing of an iso-surface is one unit before the first mark with a larger number, or one unit behind the last
///     mark.
/// So runs of segments (compositor/run_sink.hpp) end at marks that another process owns. How a segment is cut depends
/// only on the segment and the marks of its ray, which all processes have.
class FaceMarks {
 public:
  /// Removes all marks and prepares for a rectangle of `pixels` pixels.
  void reset(std::size_t pixels);
  void add(const FaceMark& mark) { marks_.push_back(mark); }
  /// Sorts the marks along their rays. Must be called after the last add().
  void sort();

  [[nodiscard]] std::size_t size() const { return marks_.size(); }
  [[nodiscard]] std::span<const FaceMark> marks() const { return marks_; }
  /// The marks of pixel p have the indices [begin()[p], begin()[p + 1]).
  [[nodiscard]] std::span<const std::uint32_t> begin() const { return begin_; }
  [[nodiscard]] std::size_t own() const { return own_; }
  /// Appends a crossing for each mark that this process owns; there must be room.
  void append_own(RaySegments& segments) const;
  /// Cuts the segments from index `first` on, and appends the resulting segments: at most one for each mark and cell.
  /// There must be room.
  void cut(RaySegments& segments, std::size_t first) const;

 private:
  void cut_one(RaySegments& segments, std::size_t at, std::span<const FaceMark> marks) const;

  std::vector<FaceMark> marks_;
  std::vector<std::uint32_t> begin_;
  std::vector<FaceMark> by_pixel_;  ///< working memory
  std::vector<std::uint32_t> next_;
  std::size_t own_ = 0;
};

}  // namespace tessera::projection
