// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/camera.hpp"

namespace tessera::scene {

/// A world point projected by a view to pixel position (x / w, y / w), with x to the right and y downwards; the centre
/// of pixel (0, 0) is at (0.5, 0.5). Orthographic views have w = 1. In perspective views w is the depth, which is
/// negative behind the eye. The caller does the division.
struct PixelPlace {
  double x, y, w;
  double depth;  ///< planar, along the view direction from the eye, world units
};

/// The linear map of a view from world to homogeneous pixel coordinates.
struct PixelView {
  ViewBasis basis;
  glm::dvec3 position;
  double half_width, half_height;  ///< half of the image's sides, in pixels
  bool perspective;
  double pixels_per_unit;  ///< pixels per world unit (orthographic) or per unit of tangent (perspective)

  /// Requires a valid camera and size.
  PixelView(const Camera& camera, ImageSize size)
      : basis(view_basis(camera)),
        position(camera.position),
        half_width(0.5 * size.width),
        half_height(0.5 * size.height),
        perspective(camera.projection == ProjectionKind::perspective),
        pixels_per_unit(half_height / (perspective ? std::tan(camera.view_angle * (std::numbers::pi / 360))
                                                   : camera.parallel_scale)) {}

  [[nodiscard]] PixelPlace project(const glm::dvec3& p_world) const {
    const glm::dvec3 p = p_world - position;
    const double depth = glm::dot(basis.forward, p), w = perspective ? depth : 1;
    return {half_width * w + glm::dot(basis.right, p) * pixels_per_unit,
            half_height * w - glm::dot(basis.up, p) * pixels_per_unit, w, depth};
  }

  /// Returns the world length per unit of planar depth along the ray through a pixel position; 1 in orthographic views.
  [[nodiscard]] double length_per_depth(double x, double y) const {
    if (!perspective) return 1;
    const double tx = (x - half_width) / pixels_per_unit, ty = (y - half_height) / pixels_per_unit;
    return std::sqrt(1 + tx * tx + ty * ty);
  }

  /// Returns the direction of the ray through a pixel position, as a world vector whose planar depth is one.
  [[nodiscard]] glm::dvec3 direction(double x, double y) const {
    if (!perspective) return basis.forward;
    return basis.forward + basis.right * ((x - half_width) / pixels_per_unit) -
           basis.up * ((y - half_height) / pixels_per_unit);
  }
};

}  // namespace tessera::scene
