// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cells/mesh_blocks.hpp"
#include "tessera/camera.hpp"

/// Scales each axis of the world by a factor (ReadOptions::axis_scale), which the user requested or this code chose.
namespace tessera::cells {

/// Returns the scale for a box whose x and y are in degrees, while z is a length. It is 1, unless the box is thinner
/// than 1:20. Then z is multiplied by the largest of 1, 2 or 5 times a power of ten that makes the extent in z at most
/// a quarter of the longer of x and y.
glm::dvec3 scale_for_degrees(const Box& box);

/// Returns the requested scale. Without a request, returns the scale derived from the box if `xy_in_degrees`, with a
/// note, and 1 otherwise.
glm::dvec3 chosen_scale(const std::optional<glm::dvec3>& asked, bool xy_in_degrees, const Box& box,
                        std::vector<std::string>& notes);

/// Scales the points of a mesh by its chosen scale, and sets `axis_scale`.
void scale_points(MeshBlocks& mesh, const std::optional<glm::dvec3>& asked);

}  // namespace tessera::cells
