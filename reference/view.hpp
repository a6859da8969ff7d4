// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

#include "scene/camera.hpp"

namespace tessera::reference {

/// A vertex in the camera's view. The ray through pixel coordinates (x, y) (x to the right, y DOWN, pixel (i, j)
/// centred at (i + 0.5, j + 0.5)) meets the vertex where (x, y, 1) is parallel to `sight`. All later computations treat
/// these doubles as exact.
struct ProjectedVertex {
  glm::dvec3 homogeneous;  ///< (X, Y, w): pixel coordinates X/w and Y/w. Orthographic: w = 1. Perspective: w = depth
  /// Decides on which side a ray passes; rounded (View::project). For a vertex in front of the eye it is (x, y, 1), for
  /// one behind the eye (-x, -y, -1), with the pixel coordinates of the line through the vertex and the eye; in the
  /// plane of the eye it is a direction (X, Y, 0). In orthographic projection it is `homogeneous`.
  glm::dvec3 sight;
  double depth;  ///< planar: along the view direction from the position, world units; negative behind the eye
};

/// The camera's geometry, implemented separately for the reference.
class View {
 public:
  /// The camera and size must be valid.
  View(const scene::Camera& camera, scene::ImageSize size);

  /// Projects a vertex. The pixel coordinates of `sight` are rounded to the nearest multiple of 2^-32 pixel. So the
  /// coordinates of vertices that should be on pixel centres, or in the plane of the eye and a row or column of pixel
  /// centres, are exact despite decimal noise in the camera. For perspective views, this unit is too fine far outside
  /// the image and for very long lenses. In these cases the unit is at least 2^(n-46) pixels, where 2^n is the power of
  /// two at or below the largest of |x|, |y| and the pixels per unit of tangent (at most 2^22). From 2^46 pixels on, a
  /// vertex counts as in the plane of the eye; the unit for X and Y is then 2^(n-40), where 2^n is the power of two at
  /// or below the larger of |X| and |Y|. The computation uses long double, so that the rounded value has no additional
  /// noise. `homogeneous` is rounded only in orthographic projection.
  [[nodiscard]] ProjectedVertex project(const glm::dvec3& p_world) const;

  /// The ray through (x, y): at planar depth z it is at `origin` + z * `step`. Not rounded.
  struct Ray {
    glm::dvec3 origin, step;
  };
  [[nodiscard]] Ray ray(double x, double y) const;

  /// Returns the world length of the ray through (x, y) per unit of planar depth: 1 in orthographic projection, larger
  /// towards the image's edges in perspective.
  [[nodiscard]] double length_per_depth(double x, double y) const;

  /// Planar depths; the visible range is strictly between them. nearest() is the eye's depth 0 or, if it is larger, the
  /// near end of the clipping range; farthest() is the far end of the clipping range, or infinite.
  [[nodiscard]] double nearest() const { return nearest_; }
  [[nodiscard]] double farthest() const { return farthest_; }

  [[nodiscard]] bool perspective() const { return perspective_; }

 private:
  using Direction = glm::vec<3, long double>;

  glm::dvec3 position_;
  glm::dvec3
      depth_axis_;  ///< forward, in double: depths are rounded once per product, as in any renderer that uses double
  Direction right_, up_, forward_;
  long double half_width_, half_height_;  ///< pixels
  long double pixels_per_unit_;  ///< orthographic: per world unit; perspective: per world unit at planar depth one
  bool perspective_;
  double nearest_, farthest_;
};

}  // namespace tessera::reference
