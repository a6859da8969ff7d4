// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"

namespace tessera::volume {

/// The voxels low <= (i, j, k) < high of a grid.
struct VoxelBox {
  scene::GridIndex low, high;

  bool operator==(const VoxelBox&) const = default;
  [[nodiscard]] static VoxelBox all_of(const scene::GridGeometry& geometry) { return {{0, 0, 0}, geometry.voxels()}; }
};

/// Divides the volume into boxes of `sides` voxels (fewer at the high ends), in an order in which every ray of the
/// camera leaves all boxes in front of a box before it enters that box. Each side is at least 1.
std::vector<VoxelBox> boxes_front_to_back(const scene::GridGeometry& geometry, const scene::GridIndex& sides,
                                          const scene::Camera& camera);

}  // namespace tessera::volume
