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

/// Where a ray meets a triangle of a surface.
struct FaceMark {
  std::uint32_t pixel;                       ///< row-major in the rectangle
  std::uint32_t number;                      ///< scene::SurfaceSet::face_crossing()
  double depth, value;                       ///< planar; the field's at the place, 0 where there is none
  double tolerance;                          ///< what rounding may have moved it by in depth
  std::array<double, 2> slope, slope_error;  ///< change of depth from a pixel to the next in x, in y
  float cosine;                              ///< of the angle between ray and normal
  bool own;                                  ///< of this process; of another's the depth alone is needed
  double place = 0, behind = 0;              ///< set by FaceMarks::sort()
};

/// The triangles that the rays of a rectangle meet, and what they do to the ray segments of its pixels, in double
/// precision.
///
/// A mark becomes a crossing among the segments (surface_crossings.hpp), put in by the one process whose triangle it
/// is. Segments are cut there by whoever has them, so that in depth order the crossing lies between their parts.
///
/// Marks of a ray whose depths differ by no more than their tolerances are at one depth, as where the ray passes an
/// edge or a corner. They are met in the order in which the ray, moved as edge_sign() moves it, meets their planes: by
/// slope in x, then in y. Marks of one plane are in the order of their numbers (scene::SurfaceSet). This order is
/// written into depths, which every exchange keeps, in steps of a double's last place:
///   - segments that end at the marks end at the depth itself;
///   - the marks follow, two steps apart, and what lies behind begins two steps behind the last;
///   - a crossing of an iso-surface lies a step before the first mark of a larger number, or a step behind the last.
/// So runs of segments (compositor/run_sink.hpp) end at a mark that another process has. What is done to a segment
/// depends on the segment and the marks of its ray alone, which all processes have.
class FaceMarks {
 public:
  /// Forgets all, and is of a rectangle of so many pixels.
  void reset(std::size_t pixels);
  void add(const FaceMark& mark) { marks_.push_back(mark); }
  /// After the last is added: puts them in the order of their rays.
  void sort();

  [[nodiscard]] std::size_t size() const { return marks_.size(); }
  [[nodiscard]] std::size_t own() const { return own_; }
  /// Appends a crossing for each own mark; there must be room.
  void append_own(RaySegments& segments) const;
  /// Cuts the segments from `first` on, and appends what that makes of them: at most one for each mark and cell. There
  /// must be room.
  void cut(RaySegments& segments, std::size_t first) const;

 private:
  void cut_one(RaySegments& segments, std::size_t at, std::span<const FaceMark> marks) const;

  std::vector<FaceMark> marks_;
  std::vector<std::uint32_t> begin_;  ///< by pixel
  std::size_t own_ = 0;
};

}  // namespace tessera::projection
