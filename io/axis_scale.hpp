#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/cell_block.hpp"
#include "tessera/camera.hpp"

/// Axes of the world multiplied by a factor each (ReadOptions::axis_scale), asked for or chosen.
namespace tessera::io {

/// Where x and y are degrees and z is a length: 1, or where the box is thinner than 1:20 the power of ten, once, twice
/// or five times, of which z needs to be at most a quarter of the longer side of the others.
glm::dvec3 scale_beside_degrees(const Box& box);

/// What is asked for; else by the box, if `beside_degrees`, with a note; else 1.
glm::dvec3 chosen_scale(const std::optional<glm::dvec3>& asked, bool beside_degrees, const Box& box,
                        std::vector<std::string>& notes);

/// Scales the points of cells.
void scale_blocks(std::span<CellBlock> blocks, const glm::dvec3& scale);

/// Box round the finite points of cells.
Box box_of_points(std::span<const CellBlock> blocks);

}  // namespace tessera::io
