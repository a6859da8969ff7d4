// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

/// More points make no hull: their number cubed is what it costs.
inline constexpr std::size_t most_hull_points = 128;

/// The faces of some points' convex hull, turning outward: of each the number of its corners, then these, as indices
/// into `positions`. What lies within `thickness` of a plane is one polygon, with all points on its outline, those on
/// its edges too. False if the points lie within that of one plane, or are too many.
bool hull_faces(std::span<const std::uint32_t> points, std::span<const glm::dvec3> positions, double thickness,
                std::vector<std::uint32_t>& faces);

}  // namespace tessera::cells
