// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace tessera::volume {

/// Returns the trilinear field of a voxel along a ray from `front` to front + rise, both in the voxel's unit cube, as
/// the coefficients of a cubic, the constant coefficient first. Corner (a, b, c) of the voxel has the value corner[a +
/// 2 b + 4 c].
std::array<double, 4> cubic_of(const std::array<double, 8>& corner, const glm::dvec3& front, const glm::dvec3& rise);

/// Inserts, between ends[0] and a final 1, the positions in (0, 1) where the derivative of a cubic is zero.
void turning_points(const std::array<double, 4>& p, std::array<double, 4>& ends, std::size_t& count);

}  // namespace tessera::volume
