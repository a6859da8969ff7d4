// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/voxel_box.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace tessera::volume {
namespace {

/// Returns the voxel along an axis that contains a position in the grid's local frame; positions outside belong to the
/// first or last voxel.
std::int64_t voxel_at(const scene::GridGeometry& geometry, std::size_t axis, double local) {
  std::int64_t low = 0, high = geometry.points[axis] - 1;
  while (high - low > 1) {
    const std::int64_t middle = low + (high - low) / 2;
    (geometry.lattice(axis, middle) <= local ? low : high) = middle;
  }
  return low;
}

}  // namespace

std::vector<VoxelBox> boxes_front_to_back(const scene::GridGeometry& geometry, const scene::GridIndex& sides,
                                          const scene::Camera& camera) {
  // Boxes are sorted by their distance from the box that contains the eye, in steps along the axes. Each box that a ray
  // enters is one step farther from the eye's box than the box that the ray leaves.
  const glm::dmat3 to_local = scene::world_to_local(geometry);
  const glm::dvec3 eye = to_local * (camera.position - geometry.origin);
  const glm::dvec3 forward = to_local * scene::view_basis(camera).forward;
  const scene::GridIndex voxels = geometry.voxels();
  scene::GridIndex counts, own;
  for (std::size_t a = 0; a < 3; ++a) {
    counts[a] = (voxels[a] + sides[a] - 1) / sides[a];
    const int axis = static_cast<int>(a);
    own[a] = camera.projection == scene::ProjectionKind::perspective ? voxel_at(geometry, a, eye[axis]) / sides[a]
             : forward[axis] < 0                                     ? counts[a] - 1
                                                                     : 0;
  }
  struct Placed {
    std::int64_t steps;
    VoxelBox box;
  };
  std::vector<Placed> placed;
  for (std::int64_t c = 0; c < counts[2]; ++c)
    for (std::int64_t b = 0; b < counts[1]; ++b)
      for (std::int64_t a = 0; a < counts[0]; ++a) {
        const scene::GridIndex place{a, b, c};
        Placed& one = placed.emplace_back();
        for (std::size_t n = 0; n < 3; ++n) {
          one.steps += std::abs(place[n] - own[n]);
          one.box.low[n] = place[n] * sides[n];
          one.box.high[n] = std::min(voxels[n], one.box.low[n] + sides[n]);
        }
      }
  std::stable_sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.steps < b.steps; });
  std::vector<VoxelBox> boxes;
  boxes.reserve(placed.size());
  for (const Placed& one : placed) boxes.push_back(one.box);
  return boxes;
}

}  // namespace tessera::volume
