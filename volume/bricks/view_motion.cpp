// SPDX-License-Identifier: BSD-3-Clause
#include "volume/bricks/view_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace tessera::volume {
namespace {

glm::dmat3 axes_of(const scene::Camera& camera) {
  const scene::ViewBasis basis = scene::view_basis(camera);
  return {basis.right, basis.up, basis.forward};
}

}  // namespace

scene::Camera next_view(const scene::Camera& before, const scene::Camera& now) {
  if (before.projection != now.projection) return now;
  const glm::dmat3 turn = axes_of(now) * glm::transpose(axes_of(before));
  const double cosine = (turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2;
  if (!(cosine > std::cos(glm::radians(45.0)))) return now;
  // Larger factors are a jump, too.
  const auto factor = [](double from, double to) { return std::clamp(to / from, 0.5, 2.0); };
  const glm::dvec3 away = now.position - now.focal_point;
  const double farther = factor(glm::length(before.position - before.focal_point), glm::length(away));
  scene::Camera next = now;
  next.focal_point = now.focal_point + (now.focal_point - before.focal_point);
  next.position = next.focal_point + turn * away * farther;
  next.view_up = turn * now.view_up;
  next.parallel_scale = now.parallel_scale * factor(before.parallel_scale, now.parallel_scale);
  next.view_angle = std::min(170.0, now.view_angle * factor(before.view_angle, now.view_angle));
  // For distant cameras, small motions vanish by rounding, but a view must have a direction.
  return glm::length(next.position - next.focal_point) > 0 ? next : now;
}

}  // namespace tessera::volume
