#pragma once

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "scene/camera.hpp"

namespace tessera::volume {

/// Where a view shows points of the world, for bounds and estimates of cost: pixel (0, 0) has its centre at (0.5, 0.5),
/// x goes right, y down.
class PixelView {
 public:
  /// At (x / w, y / w); w is 1 in orthographic projection, else the depth. Depths are planar, in world units.
  struct Place {
    double x, y, w, depth;
  };

  /// A valid camera and size.
  PixelView(const scene::Camera& camera, scene::ImageSize size)
      : basis_(scene::view_basis(camera)),
        position_(camera.position),
        half_width_(0.5 * size.width),
        half_height_(0.5 * size.height),
        perspective_(camera.projection == scene::ProjectionKind::perspective),
        pixels_per_unit_(half_height_ / (perspective_ ? std::tan(camera.view_angle * (std::numbers::pi / 360))
                                                      : camera.parallel_scale)) {}

  [[nodiscard]] Place project(const glm::dvec3& p_world) const {
    const glm::dvec3 p = p_world - position_;
    const double depth = glm::dot(basis_.forward, p), w = perspective_ ? depth : 1;
    return {half_width_ * w + glm::dot(basis_.right, p) * pixels_per_unit_,
            half_height_ * w - glm::dot(basis_.up, p) * pixels_per_unit_, w, depth};
  }

  /// World length per unit of planar depth along the ray through a pixel position.
  [[nodiscard]] double length_per_depth(double x, double y) const {
    if (!perspective_) return 1;
    const double tx = (x - half_width_) / pixels_per_unit_, ty = (y - half_height_) / pixels_per_unit_;
    return std::sqrt(1 + tx * tx + ty * ty);
  }

 private:
  scene::ViewBasis basis_;
  glm::dvec3 position_;
  double half_width_, half_height_;
  bool perspective_;
  double pixels_per_unit_;
};

}  // namespace tessera::volume
