// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "volume/frame_view.hpp"

namespace tessera::volume {

PixelRays::PixelRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                     std::span<const scene::HalfSpace> clip) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  const glm::dmat3 to_local = scene::world_to_local(geometry);
  const auto to_index = [&](const glm::dvec3& v) { return to_local * v / geometry.spacing; };
  const bool perspective = camera.projection == scene::ProjectionKind::perspective;
  const double half_height =
      perspective ? std::tan(0.5 * camera.view_angle * std::numbers::pi / 180) : camera.parallel_scale;
  const double pixel = 2 * half_height / size.height;  // world units; for perspective at depth one
  const double x0 = 0.5 * size.width, y0 = 0.5 * size.height;
  const glm::dvec3 eye = to_index(camera.position - geometry.origin), forward = to_index(basis.forward);
  const glm::dvec3 across = to_index(basis.right * pixel), down = to_index(basis.up * -pixel);
  if (perspective) {
    origin = eye, origin_x = origin_y = glm::dvec3(0);
    direction = forward - across * x0 - down * y0, direction_x = across, direction_y = down;
  } else {
    origin = eye - across * x0 - down * y0, origin_x = across, origin_y = down;
    direction = forward, direction_x = direction_y = glm::dvec3(0);
  }
  tangent_x0 = x0, tangent_y0 = y0, tangent_step = perspective ? pixel : 0.0;
  near_depth = 0, far_depth = std::numeric_limits<double>::infinity();
  if (camera.clipping_range) {
    near_depth = std::max(0.0, camera.clipping_range->near_distance);
    far_depth = camera.clipping_range->far_distance;
  }
  for (const scene::HalfSpace& h : clip) {
    const glm::dvec3 normal = scene::unit_normal(h);
    const glm::dvec3 slope = glm::transpose(geometry.direction) * normal * geometry.spacing, size_of = glm::abs(slope);
    const double largest = std::max({size_of.x, size_of.y, size_of.z});
    kept.push_back({glm::dot(normal, geometry.origin - h.point) / largest, slope / largest});
  }
}

}  // namespace tessera::volume
