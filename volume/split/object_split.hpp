// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

/// A volume divided into boxes of whole bricks, one per process, by a k-d tree (sort-last; Moloney, "Ray Coherence in
/// Parallel Volume Rendering", SFU 2008, 2.3). Each plane divides the processes of its box into two halves, and the
/// visible cells of its box in the same proportion, as closely as bricks allow. Therefore the boxes have a visibility
/// order in every view, and the division depends only on the transfer function.
class ObjectSplit {
 public:
  /// `visible`: one byte per cell of 8^3 voxels, numbered as in CellRanges. Planes are at multiples of `brick_size`
  /// voxels. If there are fewer than eight bricks of that size per process, they are at multiples of half the size, a
  /// quarter and so on, down to 8 voxels. If even these bricks are fewer than the processes, some processes get an
  /// empty box (low == high).
  ObjectSplit(const scene::GridIndex& voxels, std::span<const std::uint8_t> visible, int brick_size, int processes);

  /// One box per process.
  [[nodiscard]] const std::vector<VoxelBox>& boxes() const { return boxes_; }

  /// Returns the processes in an order in which every ray of the camera leaves the boxes of earlier processes before it
  /// enters the boxes of later ones.
  [[nodiscard]] std::vector<int> front_to_back(const scene::GridGeometry& geometry, const scene::Camera& camera) const;

 private:
  struct Plane {
    std::size_t axis = 0;
    std::int64_t voxel = 0;                  ///< the first voxel behind the plane
    int first = 0, above = 0, last = 0;      ///< processes [first, above) are below the plane, [above, last) above it
    int plane_below = -1, plane_above = -1;  ///< planes that divide these two parts further; -1: none
  };
  struct Work;
  int cut(const Work& work, const VoxelBox& box, int first, int last);

  std::vector<VoxelBox> boxes_;
  std::vector<Plane> planes_;
};

}  // namespace tessera::volume
