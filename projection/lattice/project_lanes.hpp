// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// The parameters of PixelSpace::project.
struct LinearMap {
  double position[3], right[3], up[3], forward[3];
  double half_width, half_height, pixels_per_unit;
  bool perspective;
};

/// Projects points from the beginning of `p_world`, as many as fill whole vectors, with the same bits as
/// PixelSpace::project. Returns the number of projected points.
std::size_t project_lanes(const LinearMap& map, std::span<const glm::dvec3> p_world, std::span<PixelVertex> out);

}  // namespace tessera::projection
