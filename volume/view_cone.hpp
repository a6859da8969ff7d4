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

/// By brick: how far its centre lies outside the view frustum of a region's pixels, or how deep inside (negative): the
/// largest distance to one of its side planes and that of the eye, world units. A brick whose half diagonal is less
/// is not in the view.
std::vector<float> frustum_distances(const scene::Camera& camera, scene::ImageSize size, const scene::PixelRect& region,
                                     const scene::GridGeometry& geometry, const BrickLayout& layout);

/// World units: no point of a brick is farther from its centre, samples of cells counted as lying at their low corners.
double half_brick(const scene::GridGeometry& geometry, const BrickLayout& layout);

}  // namespace tessera::volume
