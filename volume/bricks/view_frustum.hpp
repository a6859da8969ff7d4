// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/pixel_rect.hpp"
#include "volume/bricks/brick_layout.hpp"

namespace tessera::volume {

/// By brick: how far all of it lies outside the view frustum of a region's pixels, or how deep inside its nearest
/// corner (0 or less: some of it may be in view): the largest distance to a side plane or that of the eye, world units.
/// Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 3.3, has the centre's distance to a cone round the
/// frustum, in which all neighbours of a wide, low rectangle have distance 0.
std::vector<float> frustum_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                     const scene::GridGeometry& geometry, const BrickLayout& layout);

}  // namespace tessera::volume
