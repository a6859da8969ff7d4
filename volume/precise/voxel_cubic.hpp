// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec3.hpp>

namespace tessera::volume {

/// The trilinear field of a voxel, whose corner (a, b, c) has the value a + 2 b + 4 c of `corner`, along a ray from
/// `front` on over `rise`, both in the voxel's unit cube: coefficients of a cubic, the constant first.
std::array<double, 4> cubic_of(const std::array<double, 8>& corner, const glm::dvec3& front, const glm::dvec3& rise);

/// The places in (0, 1) where a cubic turns, after ends[0] and before a last 1.
void turning_points(const std::array<double, 4>& p, std::array<double, 4>& ends, std::size_t& count);

}  // namespace tessera::volume
