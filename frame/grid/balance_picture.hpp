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

/// The images of tessera::BalancePictures.
namespace tessera::frame {

/// Draws the outlines of `bricks` (low and high corners in index space) over the image, dimmed, on black; each pixel of
/// a line has the colour of the process that rendered it. White lines separate the rectangles.
void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, const volume::ImageSplit& split);

/// The same for sort-last: each brick has the colour of the process whose part of the volume contains it, and white
/// lines outline the parts.
void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, std::span<const volume::VoxelBox> parts);

/// The outlines of sort-last's parts on black, coloured as in cost_picture() from blue on by each part's CPU seconds
/// relative to the most expensive part. Opaque.
scene::Image cost_of_parts(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                           std::span<const volume::VoxelBox> parts, std::span<const double> seconds);

/// The cost map at the image's size: from black (no work) over blue, red and yellow to white at the most expensive
/// pixel; white lines separate the rectangles. Opaque.
scene::Image cost_picture(const volume::CostMap& cost, scene::ImageSize size, const volume::ImageSplit& split);

}  // namespace tessera::frame
