// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>

#include "scene/grid.hpp"
#include "volume/precise/voxel_ray.hpp"

namespace tessera::volume {

/// Returns the voxel along an axis that contains a position in the local frame, or the nearest voxel.
std::int64_t voxel_along(const scene::GridGeometry& geometry, std::size_t axis, double local);

/// A ray's path from voxel to voxel, front to back:
///
///     for (VoxelSteps at(geometry, ray); at.inside(); at.step())
///       if (at.begin() < at.end()) ...  // the ray is in at.voxel() between these planar depths
///
/// A stretch ends at lattice planes or with the ray. The depth of a plane is computed from the plane alone. Where
/// several planes are passed at once, because of rounding or at an edge, stretches of zero length occur in between.
class VoxelSteps {
 public:
  /// `geometry` and `ray` must outlive this object.
  VoxelSteps(const scene::GridGeometry& geometry, const VoxelRay& ray);

  [[nodiscard]] bool inside() const { return begin_ < ray_.end; }
  [[nodiscard]] const scene::GridIndex& voxel() const { return voxel_; }
  [[nodiscard]] double begin() const { return begin_; }
  [[nodiscard]] double end() const { return end_; }
  void step();
  /// Advances to where the ray leaves the voxels low <= (i, j, k) < high, which contain the current voxel.
  void leave(const scene::GridIndex& low, const scene::GridIndex& high);

 private:
  /// Depth of the plane between voxels `index` - 1 and `index`.
  [[nodiscard]] double plane(std::size_t axis, std::int64_t index) const {
    const int a = static_cast<int>(axis);
    return (geometry_.lattice(axis, index) - ray_.origin[a]) / ray_.step[a];
  }
  [[nodiscard]] double far_plane(std::size_t axis) const {
    return plane(axis, voxel_[axis] + (direction_[axis] > 0 ? 1 : 0));
  }
  void forward(std::size_t axis);
  void find_end();

  const scene::GridGeometry& geometry_;
  const VoxelRay& ray_;
  scene::GridIndex voxel_{}, last_{}, direction_{};
  std::array<double, 3> next_{};  ///< depth of the voxel's far plane
  std::size_t nearest_ = 0;       ///< the axis of the next plane
  double begin_, end_ = 0;
};

}  // namespace tessera::volume
