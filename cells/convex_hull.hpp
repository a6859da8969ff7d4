// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

/// Largest number of points of a convex hull. The time grows with the cube of their number.
inline constexpr std::size_t most_hull_points = 128;

/// Computes the faces of the convex hull of some points, oriented outward: for each face the number of its corners,
/// then the corners as indices of `positions`. Points within `thickness` of a plane form one polygon. Its corners are
/// all points on its outline, even those in the middle of an edge. Returns false if all points are within that distance
/// of one plane, or if there are too many points.
bool hull_faces(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions, double thickness,
                std::vector<std::uint32_t>& faces);

}  // namespace tessera::cells
