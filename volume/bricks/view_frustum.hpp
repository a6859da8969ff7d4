// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/pixel_rect.hpp"
#include "volume/bricks/brick_layout.hpp"

namespace tessera::volume {

/// Returns a distance for each brick: if positive, the distance of the whole brick from the view frustum of a region's
/// pixels; if negative, minus the depth of the brick's innermost corner in the frustum. If it is 0 or less, a part of
/// the brick may be in view. It is computed as the largest signed distance to a side plane or the eye's plane, in world
/// units. Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 3.3, uses the distance of the centre to a
/// cone around the frustum; all neighbours of a wide, low rectangle then have distance 0.
std::vector<float> frustum_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                     const scene::GridGeometry& geometry, const BrickLayout& layout);

}  // namespace tessera::volume
