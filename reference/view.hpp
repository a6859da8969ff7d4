#pragma once

#include <glm/vec3.hpp>

#include "scene/camera.hpp"

namespace tessera::reference {

/// A vertex as the camera sees it. The ray through pixel coordinates (x, y) (x to the right, y DOWN, pixel (i, j)
/// centred at (i + 0.5, j + 0.5)) meets it where (x, y, 1) is parallel to `homogeneous`. From here on these doubles are
/// exact by definition.
struct ProjectedVertex {
  glm::dvec3 homogeneous;  ///< (X, Y, w): pixel coordinates X/w and Y/w. Orthographic: w = 1. Perspective: w = depth
  double depth;            ///< planar: along the view direction from the position, world units; negative behind the eye
};

/// The camera's geometry, written out once more for the reference alone.
class View {
 public:
  /// The camera and size must be valid.
  View(const scene::Camera& camera, scene::ImageSize size);

  /// Orthographic pixel coordinates are rounded to the nearest multiple of 2^-32 pixel, so that vertices meant to lie
  /// on pixel centres do, whatever the decimal noise of the camera.
  [[nodiscard]] ProjectedVertex project(const glm::dvec3& p_world) const;

  /// The ray through (x, y): at planar depth z it is at `origin` + z * `step`. Not rounded.
  struct Ray {
    glm::dvec3 origin, step;
  };
  [[nodiscard]] Ray ray(double x, double y) const;

  /// World length of the ray through (x, y) per unit of planar depth: 1 in orthographic projection, more towards the
  /// picture's rim in perspective.
  [[nodiscard]] double length_per_depth(double x, double y) const;

  /// What is seen lies strictly between these planar depths: the eye and the clipping range, if there is one.
  [[nodiscard]] double nearest() const { return nearest_; }
  [[nodiscard]] double farthest() const { return farthest_; }

  [[nodiscard]] bool perspective() const { return perspective_; }

 private:
  glm::dvec3 position_, right_, up_, forward_;
  double half_width_, half_height_;  ///< pixels
  double pixels_per_unit_;           ///< orthographic: per world unit; perspective: per world unit at planar depth one
  bool perspective_;
  double nearest_, farthest_;
};

}  // namespace tessera::reference
