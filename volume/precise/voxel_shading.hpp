// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/shading.hpp"
#include "volume/precise/voxel_walk.hpp"

namespace tessera::volume {

/// Shading turns a colour c into own * c + white.
struct VoxelLight {
  double own = 1, white = 0;
};

/// Shading of a grid's matter, voxel by voxel in double precision (scene/shading.hpp), with light and material in world
/// space.
class VoxelShading {
 public:
  VoxelShading(const scene::Shading& shading, const scene::Camera& camera, const scene::GridGeometry& geometry)
      : shading_(shading),
        direction_(geometry.direction),
        to_world_gradient_(glm::transpose(scene::world_to_local(geometry))),
        to_light_(glm::normalize(shading.to_light)) {
    if (!shading.camera_light) return;
    const scene::ViewBasis basis = scene::view_basis(camera);
    to_light_ = basis.right * to_light_.x + basis.up * to_light_.y - basis.forward * to_light_.z;
  }

  /// The shading of a ray's stretch in a voxel, from the gradient of the trilinear field at its middle.
  [[nodiscard]] VoxelLight light(const VoxelStretch& s, const glm::dvec3& step) const {
    const glm::dvec3 p = s.front + s.rise * 0.5;
    const std::array<double, 8>& v = s.corner;
    const auto between = [](double a, double b, double c, double d, double x, double y) {
      return (a * (1 - x) + b * x) * (1 - y) + (c * (1 - x) + d * x) * y;
    };
    const glm::dvec3 slope(between(v[1] - v[0], v[3] - v[2], v[5] - v[4], v[7] - v[6], p.y, p.z),
                           between(v[2] - v[0], v[3] - v[1], v[6] - v[4], v[7] - v[5], p.x, p.z),
                           between(v[4] - v[0], v[5] - v[1], v[6] - v[2], v[7] - v[3], p.x, p.y));
    // Differences no larger than the rounding of the data contain no information about a direction.
    constexpr double rounding = 1e-12;
    double largest = 0;
    for (const double value : v) largest = std::max(largest, std::abs(value));
    const glm::dvec3 local = slope / s.side;
    if (!(glm::length(local) * std::min({s.side.x, s.side.y, s.side.z}) > rounding * largest)) return {};
    const glm::dvec3 gradient = to_world_gradient_ * local;
    const double steepness = glm::length(gradient);
    const glm::dvec3 normal = gradient / steepness, half = to_light_ - glm::normalize(direction_ * step);
    const double width = glm::length(half), n_h = width > 1e-12 ? std::abs(glm::dot(normal, half)) / width : 0;
    return {shading_.ambient + shading_.diffuse * std::abs(glm::dot(normal, to_light_)),
            shading_.specular * std::pow(n_h, shading_.shininess)};
  }

 private:
  scene::Shading shading_;
  glm::dmat3 direction_, to_world_gradient_;
  glm::dvec3 to_light_;
};

}  // namespace tessera::volume
