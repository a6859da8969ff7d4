// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "tessera/camera.hpp"

/// Scales the world's axes by a factor each (ReadOptions::axis_scale), requested or chosen.
namespace tessera::cells {

/// For x and y in degrees and z a length: 1, unless the box is thinner than 1:20; then z is multiplied by the largest
/// of 1, 2 or 5 times a power of ten that makes it at most a quarter of the longer of x and y.
glm::dvec3 scale_for_degrees(const Box& box);

/// The requested scale; otherwise, if `xy_in_degrees`, one derived from the box, with a note; otherwise 1.
glm::dvec3 chosen_scale(const std::optional<glm::dvec3>& asked, bool xy_in_degrees, const Box& box,
                        std::vector<std::string>& notes);

/// Scales the points of cells.
void scale_blocks(std::span<CellBlock> blocks, const glm::dvec3& scale);

/// Box around the finite points of cells.
Box box_of_points(std::span<const CellBlock> blocks);

}  // namespace tessera::cells
