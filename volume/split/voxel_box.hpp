// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"

namespace tessera::volume {

/// The voxels low <= (i, j, k) < high of a grid: a chunk of it.
struct VoxelBox {
  scene::GridIndex low, high;

  bool operator==(const VoxelBox&) const = default;
  [[nodiscard]] static VoxelBox all_of(const scene::GridGeometry& geometry) { return {{0, 0, 0}, geometry.voxels()}; }
};

/// The volume in boxes of `sides` voxels (less at the high ends), such that no ray of the camera comes to one before it
/// has left all that lie in front of it. Each side is 1 or more.
std::vector<VoxelBox> boxes_front_to_back(const scene::GridGeometry& geometry, const scene::GridIndex& sides,
                                          const scene::Camera& camera);

}  // namespace tessera::volume
