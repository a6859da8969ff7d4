// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/voxel_ray.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "volume/precise/voxel_steps.hpp"

namespace tessera::volume {
namespace {

constexpr double in_plane = 1e-9;  ///< in voxels; a ray this close to a lattice plane counts as being in the plane

}  // namespace

VoxelRays::VoxelRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                     std::span<const scene::HalfSpace> clip)
    : camera_(camera),
      geometry_(geometry),
      basis_(scene::view_basis(camera)),
      to_local_(scene::world_to_local(geometry)),
      perspective_(camera.projection == scene::ProjectionKind::perspective),
      width_(size.width),
      height_(size.height) {
  const double half = perspective_ ? std::tan(camera.view_angle * std::numbers::pi / 360) : camera.parallel_scale;
  pixel_ = 2 * half / size.height;
  const scene::Box box = scene::bounds(geometry);
  for (int n = 0; n < 8; ++n) {
    const glm::dvec3 p((n & 1) != 0 ? box.high.x : box.low.x, (n & 2) != 0 ? box.high.y : box.low.y,
                       (n & 4) != 0 ? box.high.z : box.low.z);
    deepest_ = std::max(deepest_, std::abs(glm::dot(p - camera.position, basis_.forward)));
  }
  for (const scene::HalfSpace& h : clip) clip_.push_back({h.point, scene::unit_normal(h)});
}

void VoxelRays::cut(const glm::dvec3& from, const glm::dvec3& step, VoxelRay& ray) const {
  double voxel = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t last = geometry_.points[a] - 1;
    voxel = std::min(voxel, (geometry_.lattice(a, last) - geometry_.lattice(a, 0)) / static_cast<double>(last));
  }
  for (const scene::HalfSpace& h : clip_) {
    const double climb = glm::dot(h.normal, step), height = glm::dot(h.normal, from - h.point);
    if (std::abs(climb) * deepest_ >= in_plane * voxel) {
      // A clip plane that coincides, up to rounding, with the volume's boundary also cuts the ray.
      const double z = -height / climb;
      double& end = climb > 0 ? ray.begin : ray.end;
      const bool there = std::abs(z - end) <= 1e-12 * (std::abs(z) + std::abs(end)),
                 nearer = climb > 0 ? z > end : z < end;
      if (nearer) end = z;
      if (nearer || there) (climb > 0 ? ray.begin_cut : ray.end_cut) = end;
      continue;
    }
    double side = height;
    if (std::abs(height) < in_plane * voxel) {
      const double by_x = glm::dot(h.normal, basis_.right), by_y = -glm::dot(h.normal, basis_.up);
      side = std::abs(by_x) > in_plane ? by_x : by_y;
    }
    if (side < 0) ray.end = ray.begin;
  }
}

VoxelRay VoxelRays::ray(double x, double y) const {
  const glm::dvec3 off = basis_.right * ((x - 0.5 * width_) * pixel_) + basis_.up * ((0.5 * height_ - y) * pixel_);
  const glm::dvec3 from = perspective_ ? camera_.position : camera_.position + off;
  const glm::dvec3 step = perspective_ ? basis_.forward + off : basis_.forward;
  VoxelRay ray{to_local_ * (from - geometry_.origin), to_local_ * step, glm::length(step), 0,
               std::numeric_limits<double>::infinity()};
  if (camera_.clipping_range) {
    ray.begin = std::max(0.0, camera_.clipping_range->near_distance);
    ray.end = camera_.clipping_range->far_distance;
  }
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const double low = geometry_.lattice(a, 0), high = geometry_.lattice(a, geometry_.points[a] - 1);
    const double voxel = (high - low) / static_cast<double>(geometry_.points[a] - 1);
    if (std::abs(ray.step[axis]) * deepest_ < in_plane * voxel) {
      // With rounding errors, the ray would change sides along its path.
      const double by_x = (to_local_ * basis_.right)[axis] * pixel_ * (perspective_ ? deepest_ : 1.0),
                   by_y = -(to_local_ * basis_.up)[axis];
      ray.step[axis] = 0;
      ray.aside[axis] = std::copysign(in_plane * voxel, std::abs(by_x) > in_plane * voxel ? by_x : by_y);
      const double place = ray.origin[axis] + ray.aside[axis];
      if (place < low || place >= high) {
        ray.end = ray.begin;
        continue;
      }
      const std::int64_t n = voxel_along(geometry_, a, place);
      for (const double plane : {geometry_.lattice(a, n), geometry_.lattice(a, n + 1)})
        if (std::abs(ray.origin[axis] - plane) < in_plane * voxel) ray.origin[axis] = plane;
      continue;
    }
    const double one = (low - ray.origin[axis]) / ray.step[axis], other = (high - ray.origin[axis]) / ray.step[axis];
    ray.begin = std::max(ray.begin, std::min(one, other));
    ray.end = std::min(ray.end, std::max(one, other));
  }
  cut(from, step, ray);
  return ray;
}

}  // namespace tessera::volume
