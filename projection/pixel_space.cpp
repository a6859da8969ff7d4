// SPDX-License-Identifier: BSD-3-Clause
#include "projection/pixel_space.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "projection/lattice/project_lanes.hpp"

namespace tessera::projection {
namespace {

double on_grid(double pixel) {
  constexpr double cells = 4294967296.0;  // 2^32; beyond 2^20 pixels, the rounding has no effect
  const double scaled = pixel * cells;
  return std::isfinite(scaled) ? std::nearbyint(scaled) / cells : pixel;
}

scene::PixelView checked_view(const scene::Camera& camera, scene::ImageSize size) {
  scene::validate(camera);
  scene::validate(size);
  return {camera, size};
}

}  // namespace

PixelSpace::PixelSpace(const scene::Camera& camera, scene::ImageSize size)
    : view_(checked_view(camera, size)),
      size_(size),
      near_(camera.clipping_range ? std::max(0.0, camera.clipping_range->near_distance) : 0),
      far_(camera.clipping_range ? camera.clipping_range->far_distance : std::numeric_limits<double>::infinity()) {}

PixelVertex PixelSpace::project(const glm::dvec3& p_world) const {
  PixelVertex v = view_.project(p_world);
  if (!view_.perspective) v.x = on_grid(v.x), v.y = on_grid(v.y);
  return v;
}

void PixelSpace::project(std::span<const glm::dvec3> p_world, std::span<PixelVertex> out) const {
  const auto& [right, up, forward] = view_.basis;
  const glm::dvec3& position = view_.position;
  const LinearMap map{{position.x, position.y, position.z},
                      {right.x, right.y, right.z},
                      {up.x, up.y, up.z},
                      {forward.x, forward.y, forward.z},
                      view_.half_width,
                      view_.half_height,
                      view_.pixels_per_unit,
                      view_.perspective};
  const std::size_t done = project_lanes(map, p_world, out);
  for (std::size_t i = done; i < p_world.size(); ++i) out[i] = project(p_world[i]);
}

}  // namespace tessera::projection
