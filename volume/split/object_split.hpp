// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

/// A volume cut into boxes of whole bricks, one a process (sort-last; Moloney, "Ray Coherence in Parallel Volume
/// Rendering", SFU 2008, 2.3): by planes, each of which divides the processes of its box in two halves and their
/// visible cells in the same proportion as well as bricks allow (a k-d tree). So a view sees the boxes one behind the
/// other, whichever it is, and the cut depends on the transfer function alone.
class ObjectSplit {
 public:
  /// `visible`: a byte for each cell of 8^3 voxels, as CellRanges numbers them. Planes lie at multiples of `brick_size`
  /// voxels; of half that, a quarter and so on down to 8 where there are fewer than eight such bricks a process. Where
  /// even those are fewer than processes, some get an empty box (low == high).
  ObjectSplit(const scene::GridIndex& voxels, std::span<const std::uint8_t> visible, int brick_size, int processes);

  /// Of each process.
  [[nodiscard]] const std::vector<VoxelBox>& boxes() const { return boxes_; }

  /// Processes in an order in which no ray of the camera comes to one's box before it has left those of all before it.
  [[nodiscard]] std::vector<int> front_to_back(const scene::GridGeometry& geometry, const scene::Camera& camera) const;

 private:
  struct Plane {
    std::size_t axis = 0;
    std::int64_t voxel = 0;                  ///< first one behind the plane
    int first = 0, above = 0, last = 0;      ///< processes first .. above - 1 are below it, above .. last - 1 above it
    int plane_below = -1, plane_above = -1;  ///< that cut those further; -1: none
  };
  struct Work;
  int cut(const Work& work, const VoxelBox& box, int first, int last);

  std::vector<VoxelBox> boxes_;
  std::vector<Plane> planes_;
};

}  // namespace tessera::volume
