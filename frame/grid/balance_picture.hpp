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

/// How tessera::BalancePictures draws its images.
namespace tessera::frame {

/// Dims the image, blends it with black, and draws the outlines of `bricks` over it (low and high corners of each brick
/// in index space). Each pixel of a line has the colour of the process that rendered this pixel. White lines separate
/// the rectangles.
void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, const volume::ImageSplit& split);

/// The same for sort-last. Each brick has the colour of the process whose part of the volume contains the brick, and
/// white lines outline the parts.
void draw_bricks(scene::Image& image, const scene::Camera& camera, const scene::GridGeometry& geometry,
                 std::span<const std::array<glm::dvec3, 2>> bricks, std::span<const volume::VoxelBox> parts);

/// Draws the outlines of sort-last's parts on black. The colour of a part shows its CPU seconds relative to the most
/// expensive part, in the colours of cost_picture() from blue to white. The image is opaque.
scene::Image cost_of_parts(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
                           std::span<const volume::VoxelBox> parts, std::span<const double> seconds);

/// Draws the cost map at the size of the image. Colours range from black (no work) over blue, red and yellow to white
/// (the most expensive pixel). White lines separate the rectangles. The image is opaque.
scene::Image cost_picture(const volume::CostMap& cost, scene::ImageSize size, const volume::ImageSplit& split);

}  // namespace tessera::frame
