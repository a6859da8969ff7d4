// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <span>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/image.hpp"
#include "volume/split/image_split.hpp"
#include "volume/split/voxel_box.hpp"

/// What tessera::BalancePictures shows.
namespace tessera::frame {

/// Draws the outlines of `bricks` (low and high corners in index space) over the picture, dimmed, on black; each pixel
/// of a line in the colour of the process that rendered it. Where rectangles meet there is a white line.
void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, const volume::ImageSplit& split);

/// The same of sort-last: each brick in the colour of the process whose part of the volume it is in, and white lines
/// round the parts.
void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, std::span<const volume::VoxelBox> parts);

/// The outlines of sort-last's parts on black, in the colours of cost_picture() from blue on, by the CPU seconds that
/// each took over those of the dearest. Opaque.
scene::Image cost_of_parts(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                           std::span<const volume::VoxelBox> parts, std::span<const double> seconds);

/// The cost map at the picture's size: black where nothing is to be done, over blue, red and yellow to white at the
/// dearest pixel, and white lines where rectangles meet. Opaque.
scene::Image cost_picture(const volume::CostMap& cost, scene::ImageSize size, const volume::ImageSplit& split);

}  // namespace tessera::frame
