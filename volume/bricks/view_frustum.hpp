// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/pixel_rect.hpp"
#include "volume/bricks/brick_layout.hpp"

namespace tessera::volume {

/// By brick: the distance of the whole brick from the view frustum of a region's pixels, or, if negative, minus the
/// depth of its innermost corner (0 or less: part of it may be in view). It is the largest signed distance to a side
/// plane or the eye's plane, in world units. Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 3.3, uses
/// the distance of the centre to a cone around the frustum, where all neighbours of a wide, low rectangle have distance
/// 0.
std::vector<float> frustum_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                     const scene::GridGeometry& geometry, const BrickLayout& layout);

}  // namespace tessera::volume
