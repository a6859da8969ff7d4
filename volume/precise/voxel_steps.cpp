// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/voxel_steps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::volume {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

std::int64_t voxel_along(const scene::GridGeometry& geometry, std::size_t axis, double local) {
  std::int64_t low = 0, high = geometry.points[axis] - 1;
  if (!geometry.rectilinear(axis)) {
    const double place = std::floor(local / geometry.spacing[static_cast<int>(axis)]);
    return static_cast<std::int64_t>(std::clamp(place, 0.0, static_cast<double>(high - 1)));
  }
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (geometry.lattice(axis, middle) <= local ? low : high) = middle;
  }
  return low;
}

VoxelSteps::VoxelSteps(const scene::GridGeometry& geometry, const VoxelRay& ray)
    : geometry_(geometry), ray_(ray), begin_(ray.begin) {
  if (!inside()) return;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    direction_[a] = ray.step[axis] < 0 ? -1 : 1;
    voxel_[a] = voxel_along(geometry, a, ray.origin[axis] + ray.begin * ray.step[axis] + ray.aside[axis]);
    last_[a] = direction_[a] > 0 ? geometry.points[a] - 2 : 0;
    next_[a] = ray.step[axis] == 0 ? never : far_plane(a);
  }
  find_end();
}

void VoxelSteps::find_end() {
  nearest_ = next_[0] <= next_[1] && next_[0] <= next_[2] ? 0 : next_[1] <= next_[2] ? 1 : 2;
  end_ = std::min(next_[nearest_], ray_.end);
}

void VoxelSteps::forward(std::size_t axis) {
  if (voxel_[axis] == last_[axis]) {
    next_[axis] = never;
  } else {
    voxel_[axis] += direction_[axis];
    next_[axis] = far_plane(axis);
  }
}

void VoxelSteps::step() {
  // Planes may have been passed already, because of rounding or together with another plane.
  begin_ = std::max(begin_, end_);
  if (next_[nearest_] == never) {
    begin_ = ray_.end;
    return;
  }
  forward(nearest_);
  find_end();
}

void VoxelSteps::leave(const scene::GridIndex& low, const scene::GridIndex& high) {
  double out = ray_.end;
  for (std::size_t a = 0; a < 3; ++a)
    if (next_[a] != never) out = std::min(out, plane(a, direction_[a] > 0 ? high[a] : low[a]));
  if (out > end_) {
    for (std::size_t a = 0; a < 3; ++a) {
      if (next_[a] == never) continue;
      const int axis = static_cast<int>(a);
      const std::int64_t there =
          std::clamp(voxel_along(geometry_, a, ray_.origin[axis] + out * ray_.step[axis]), low[a], high[a] - 1);
      // This is within one or two voxels of the result; planes up to `out` are then passed one by one.
      if ((there - voxel_[a]) * direction_[a] > 1) voxel_[a] = there - direction_[a], next_[a] = far_plane(a);
      while (next_[a] > out && voxel_[a] != (direction_[a] > 0 ? low[a] : high[a] - 1) &&
             plane(a, voxel_[a] + (direction_[a] > 0 ? 0 : 1)) > out) {
        voxel_[a] -= direction_[a];
        next_[a] = far_plane(a);
      }
      while (next_[a] <= out && next_[a] != never) forward(a);
    }
    begin_ = out;
    find_end();
    return;
  }
  step();
}

}  // namespace tessera::volume
