// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/camera.hpp"

namespace tessera::scene {

/// A world point as projected by a view: at (x / w, y / w), x to the right, y down, pixel (0, 0) with its centre at
/// (0.5, 0.5). Orthographic: w = 1. Perspective: w = depth, negative behind the eye; the division is left to the
/// caller.
struct PixelPlace {
  double x, y, w;
  double depth;  ///< planar, along the view direction from the eye, world units
};

/// The linear map of a view from world to homogeneous pixel coordinates.
struct PixelView {
  ViewBasis basis;
  glm::dvec3 position;
  double half_width, half_height;  ///< of the image, pixels
  bool perspective;
  double pixels_per_unit;  ///< orthographic: per world unit; perspective: per unit of tangent

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

  /// World length per unit of planar depth along the ray through a pixel position: 1 in orthographic projection.
  [[nodiscard]] double length_per_depth(double x, double y) const {
    if (!perspective) return 1;
    const double tx = (x - half_width) / pixels_per_unit, ty = (y - half_height) / pixels_per_unit;
    return std::sqrt(1 + tx * tx + ty * ty);
  }

  /// Direction of the ray through a pixel position, in the world: one unit of planar depth.
  [[nodiscard]] glm::dvec3 direction(double x, double y) const {
    if (!perspective) return basis.forward;
    return basis.forward + basis.right * ((x - half_width) / pixels_per_unit) -
           basis.up * ((y - half_height) / pixels_per_unit);
  }
};

}  // namespace tessera::scene
