// SPDX-License-Identifier: BSD-3-Clause
#include "reference/kept_interval.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace tessera::reference {
namespace {

constexpr double in_plane = 1e-13;

/// Whether a ray parallel to the plane is on the kept side.
bool is_kept(const View& view, double x, double y, const scene::HalfSpace& h, const glm::dvec3& normal) {
  const View::Ray ray = view.ray(x, y);
  const double distance = glm::dot(normal, ray.origin - h.point);
  if (std::abs(distance) > in_plane * glm::dot(glm::abs(normal), glm::abs(ray.origin) + glm::abs(h.point)))
    return distance > 0;
  // Returns how far a shift of the pixel coordinates moves the ray along the normal: at the eye, plus per unit of
  // depth. The second term is zero if the shifted ray, too, is parallel to the plane.
  const auto moved = [&](double dx, double dy) {
    const View::Ray other = view.ray(x + dx, y + dy);
    return glm::dot(normal, other.origin - ray.origin) + glm::dot(normal, other.step - ray.step);
  };
  const double by_x = moved(1, 0), by_y = moved(0, 1);
  return (std::abs(by_x) > in_plane * std::abs(by_y) ? by_x : by_y) > 0;
}

}  // namespace

DepthInterval kept_interval(const View& view, double x, double y, std::span<const scene::HalfSpace> kept) {
  DepthInterval interval{view.nearest(), view.farthest()};
  if (kept.empty()) return interval;
  const View::Ray ray = view.ray(x, y);
  for (const scene::HalfSpace& h : kept) {
    const glm::dvec3 size = glm::abs(h.normal);
    const glm::dvec3 normal = glm::normalize(h.normal / std::max({size.x, size.y, size.z}));
    const double climb = glm::dot(normal, ray.step);
    if (std::abs(climb) <= in_plane * glm::length(ray.step)) {
      if (!is_kept(view, x, y, h, normal)) interval.farthest = interval.nearest;
      continue;
    }
    const double depth = glm::dot(normal, h.point - ray.origin) / climb;
    if (climb > 0 && depth > interval.nearest) interval.nearest = depth, interval.nearest_plane = &h;
    if (!(climb > 0) && depth < interval.farthest) interval.farthest = depth, interval.farthest_plane = &h;
  }
  return interval;
}

}  // namespace tessera::reference
