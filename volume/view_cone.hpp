#pragma once

#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/pixel_rect.hpp"
#include "volume/brick_layout.hpp"

namespace tessera::volume {

/// By brick: distance of its centre to the cone round the view frustum of a region's pixels, world units, 0 inside
/// (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 3.3). In orthographic views the cone is a
/// cylinder.
std::vector<float> cone_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                  const scene::GridGeometry& geometry, const BrickLayout& layout);

}  // namespace tessera::volume
