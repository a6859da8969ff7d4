// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

/// More points are not hulled: the cost is the cube of their number.
inline constexpr std::size_t most_hull_points = 128;

/// The faces of the convex hull of some points, oriented outward: for each the number of its corners, then these, as
/// indices into `positions`. Points within `thickness` of a plane form one polygon that has all points on its outline,
/// including those on its edges. False if all points are within that distance of one plane, or are too many.
bool hull_faces(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions, double thickness,
                std::vector<std::uint32_t>& faces);

}  // namespace tessera::cells
