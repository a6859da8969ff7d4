// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/object_split.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numeric>
#include <optional>

#include "volume/bricks/cell_ranges.hpp"

namespace tessera::volume {

/// The volume to be divided.
struct ObjectSplit::Work {
  scene::GridIndex cells;
  std::span<const std::uint8_t> visible;
  std::int64_t grain;  ///< number of voxels between two possible planes

  /// Returns the visible voxels of each slab of a box, for slabs of `grain` voxels along each axis.
  [[nodiscard]] std::array<std::vector<double>, 3> slabs(const VoxelBox& box) const {
    std::array<std::vector<double>, 3> slabs;
    for (std::size_t a = 0; a < 3; ++a)
      slabs[a].assign(static_cast<std::size_t>((box.high[a] - box.low[a] + grain - 1) / grain), 0.0);
    constexpr std::int64_t side = CellRanges::side;
    const auto last = [&](std::size_t a) { return (box.high[a] + side - 1) / side; };
    for (std::int64_t c = box.low[2] / side; c < last(2); ++c)
      for (std::int64_t b = box.low[1] / side; b < last(1); ++b)
        for (std::int64_t a = box.low[0] / side; a < last(0); ++a)
          if (visible[static_cast<std::size_t>(a + cells[0] * (b + cells[1] * c))] != 0) add({a, b, c}, box, slabs);
    return slabs;
  }

 private:
  void add(const scene::GridIndex& cell, const VoxelBox& box, std::array<std::vector<double>, 3>& slabs) const {
    std::array<std::int64_t, 3> low{}, high{};
    double voxels = 1;
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::max(box.low[a], cell[a] * CellRanges::side);
      high[a] = std::min(box.high[a], (cell[a] + 1) * CellRanges::side);
      voxels *= static_cast<double>(high[a] - low[a]);
    }
    for (std::size_t a = 0; a < 3; ++a)
      for (std::int64_t from = low[a]; from < high[a];) {
        const std::int64_t slab = (from - box.low[a]) / grain;
        const std::int64_t to = std::min(high[a], box.low[a] + (slab + 1) * grain);
        slabs[a][static_cast<std::size_t>(slab)] +=
            voxels * static_cast<double>(to - from) / static_cast<double>(high[a] - low[a]);
        from = to;
      }
  }
};

namespace {

struct Cut {
  std::size_t axis;
  std::int64_t voxel;
};

/// Returns the plane that has about `share` of a box's work below it. The plane is across the longest axis, unless
/// another axis gives a clearly better division.
std::optional<Cut> best_cut(const std::array<std::vector<double>, 3>& slabs, const VoxelBox& box, std::int64_t grain,
                            double share) {
  std::int64_t longest = 0;
  for (std::size_t a = 0; a < 3; ++a) longest = std::max(longest, box.high[a] - box.low[a]);
  std::optional<Cut> best;
  double best_score = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double total = std::accumulate(slabs[a].begin(), slabs[a].end(), 0.0);
    const auto count = slabs[a].size();
    double below = 0;
    for (std::size_t s = 1; s < count; ++s) {
      below += slabs[a][s - 1];
      // If there are no visible voxels, and among empty slabs, the numbers of voxels are compared.
      const double by_voxels = std::abs(static_cast<double>(s) / static_cast<double>(count) - share);
      const double off = total > 0 ? std::abs(below / total - share) + 1e-3 * by_voxels : by_voxels;
      const double slender = static_cast<double>(box.high[a] - box.low[a]) / static_cast<double>(longest);
      const double score = off + 0.05 * (1 - slender);
      if (best && score >= best_score) continue;
      best = Cut{a, box.low[a] + static_cast<std::int64_t>(s) * grain};
      best_score = score;
    }
  }
  return best;
}

/// Returns the brick size, or a fraction of the brick size if there are few bricks.
std::int64_t grain_of(const scene::GridIndex& voxels, int brick_size, int processes) {
  std::int64_t grain = brick_size;
  const auto count = [&] {
    double count = 1;
    for (const std::int64_t n : voxels) {
      const std::int64_t along = (n + grain - 1) / grain;
      count *= static_cast<double>(along);
    }
    return count;
  };
  while (grain / 2 >= CellRanges::side && count() < 8.0 * processes) grain /= 2;
  return grain;
}

}  // namespace

ObjectSplit::ObjectSplit(const scene::GridIndex& voxels, std::span<const std::uint8_t> visible, int brick_size,
                         int processes)
    : boxes_(static_cast<std::size_t>(processes), VoxelBox{{0, 0, 0}, {0, 0, 0}}) {
  Work work{{}, visible, grain_of(voxels, brick_size, processes)};
  for (std::size_t a = 0; a < 3; ++a) work.cells[a] = (voxels[a] + CellRanges::side - 1) / CellRanges::side;
  cut(work, {{0, 0, 0}, voxels}, 0, processes);
}

/// Assigns the box to processes first .. last - 1. Returns the index of the plane that divides the box; -1 if it is not
/// divided.
int ObjectSplit::cut(const Work& work, const VoxelBox& box, int first, int last) {
  const int above = first + (last - first) / 2;
  const std::optional<Cut> where =
      last - first > 1 ? best_cut(work.slabs(box), box, work.grain, static_cast<double>(above - first) / (last - first))
                       : std::nullopt;
  if (!where) {  // one process, or a single brick: the other processes get empty boxes
    boxes_[static_cast<std::size_t>(first)] = box;
    return -1;
  }
  const auto number = planes_.size();
  planes_.push_back({where->axis, where->voxel, first, above, last});
  VoxelBox low = box, high = box;
  low.high[where->axis] = high.low[where->axis] = where->voxel;
  const int below = cut(work, low, first, above);
  const int beyond = cut(work, high, above, last);
  planes_[number].plane_below = below, planes_[number].plane_above = beyond;
  return static_cast<int>(number);
}

std::vector<int> ObjectSplit::front_to_back(const scene::GridGeometry& geometry, const scene::Camera& camera) const {
  const glm::dmat3 to_local = scene::world_to_local(geometry);
  const glm::dvec3 eye = to_local * (camera.position - geometry.origin);
  const glm::dvec3 forward = to_local * scene::view_basis(camera).forward;
  std::vector<int> order;
  const auto add = [&](const auto& self, int plane, int first, int last) -> void {
    if (plane < 0) {
      for (int process = first; process < last; ++process) order.push_back(process);
      return;
    }
    const Plane& p = planes_[static_cast<std::size_t>(plane)];
    const auto axis = static_cast<int>(p.axis);
    const bool low_first = camera.projection == scene::ProjectionKind::perspective
                               ? eye[axis] < geometry.lattice(p.axis, p.voxel)
                               : forward[axis] >= 0;
    if (low_first) self(self, p.plane_below, p.first, p.above);
    self(self, p.plane_above, p.above, p.last);
    if (!low_first) self(self, p.plane_below, p.first, p.above);
  };
  add(add, planes_.empty() ? -1 : 0, 0, static_cast<int>(boxes_.size()));
  return order;
}

}  // namespace tessera::volume
