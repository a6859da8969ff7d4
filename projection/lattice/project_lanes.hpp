// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// What PixelSpace::project computes with, by name.
struct LinearMap {
  double position[3], right[3], up[3], forward[3];
  double half_width, half_height, pixels_per_unit;
  bool perspective;
};

/// Projects as many points from the front as fill whole vectors, to the bits of PixelSpace::project; returns how many.
std::size_t project_lanes(const LinearMap& map, std::span<const glm::dvec3> p_world, std::span<PixelVertex> out);

}  // namespace tessera::projection
