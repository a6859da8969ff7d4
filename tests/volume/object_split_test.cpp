// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/object_split.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "volume/small_volume.hpp"

namespace tessera::object_split_test {
namespace {

using volume::ObjectSplit;
using volume::VoxelBox;

std::int64_t cells_along(std::int64_t voxels) { return (voxels + 7) / 8; }

std::int64_t volume_of(const VoxelBox& box) {
  return (box.high[0] - box.low[0]) * (box.high[1] - box.low[1]) * (box.high[2] - box.low[2]);
}

bool overlap(const VoxelBox& a, const VoxelBox& b) {
  for (std::size_t n = 0; n < 3; ++n)
    if (std::max(a.low[n], b.low[n]) >= std::min(a.high[n], b.high[n])) return false;
  return true;
}

/// Cells that are visible with the probability of their octant.
std::vector<std::uint8_t> random_cells(const scene::GridIndex& voxels, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  double chance[8];
  for (double& c : chance) c = uniform(random) < 0.3 ? 0 : uniform(random);
  std::vector<std::uint8_t> visible;
  const std::int64_t nx = cells_along(voxels[0]), ny = cells_along(voxels[1]), nz = cells_along(voxels[2]);
  for (std::int64_t c = 0; c < nz; ++c)
    for (std::int64_t b = 0; b < ny; ++b)
      for (std::int64_t a = 0; a < nx; ++a) {
        const int octant = (2 * a >= nx ? 1 : 0) + (2 * b >= ny ? 2 : 0) + (2 * c >= nz ? 4 : 0);
        visible.push_back(uniform(random) < chance[octant] ? 1 : 0);
      }
  return visible;
}

TEST(ObjectSplit, BoxesMakeUpTheVolumeForAnyNumberOfProcesses) {
  std::mt19937 random(11);
  std::uniform_int_distribution<std::int64_t> length(1, 90);
  for (int trial = 0; trial < 60; ++trial) {
    const scene::GridIndex voxels{length(random), length(random), length(random)};
    const std::vector<std::uint8_t> visible = random_cells(voxels, random);
    for (const int processes : {1, 2, 3, 5, 7, 12}) {
      for (const int brick : {5, 16, 32}) {
        const ObjectSplit split(voxels, visible, brick, processes);
        const std::vector<VoxelBox>& boxes = split.boxes();
        ASSERT_EQ(boxes.size(), static_cast<std::size_t>(processes));
        std::int64_t sum = 0;
        for (std::size_t a = 0; a < boxes.size(); ++a) {
          sum += volume_of(boxes[a]);
          for (std::size_t b = 0; b < a; ++b) EXPECT_FALSE(overlap(boxes[a], boxes[b])) << a << ' ' << b;
        }
        EXPECT_EQ(sum, voxels[0] * voxels[1] * voxels[2]);
      }
    }
  }
}

TEST(ObjectSplit, SharesTheCellsThatShow) {
  // Everything visible is in one corner, an eighth of the volume.
  const scene::GridIndex voxels{256, 256, 256};
  std::vector<std::uint8_t> visible(32 * 32 * 32, 0);
  for (std::size_t c = 0; c < 16; ++c)
    for (std::size_t b = 0; b < 16; ++b)
      for (std::size_t a = 0; a < 16; ++a) visible[a + 32 * (b + 32 * c)] = 1;
  for (const int processes : {2, 4, 6}) {
    const ObjectSplit split(voxels, visible, 16, processes);
    for (const VoxelBox& box : split.boxes()) {
      double shown = 1;
      for (std::size_t n = 0; n < 3; ++n)
        shown *= static_cast<double>(std::max<std::int64_t>(0, std::min<std::int64_t>(128, box.high[n]) - box.low[n]));
      // A plane of bricks is an eighth of the part that is halved or cut in three.
      EXPECT_NEAR(shown * processes / (128.0 * 128 * 128), 1, 0.4) << processes;
    }
  }
}

/// Boxes that a ray meets, from the eye on, found by small steps along it.
std::vector<int> boxes_on(const glm::dvec3& origin, const glm::dvec3& direction, const scene::GridGeometry& geometry,
                          const ObjectSplit& split) {
  std::vector<int> met;
  for (int step = 0; step < 4000; ++step) {
    const glm::dvec3 index = scene::index_of_world(geometry, origin + direction * (step * 0.0025));
    for (std::size_t box = 0; box < split.boxes().size(); ++box) {
      bool inside = true;
      for (int a = 0; a < 3; ++a) {
        const auto n = static_cast<std::size_t>(a);
        inside = inside && index[a] > static_cast<double>(split.boxes()[box].low[n]) + 1e-9 &&
                 index[a] < static_cast<double>(split.boxes()[box].high[n]) - 1e-9;
      }
      if (inside && (met.empty() || met.back() != static_cast<int>(box))) met.push_back(static_cast<int>(box));
    }
  }
  return met;
}

TEST(ObjectSplit, NoRayComesToABoxBeforeItHasLeftThoseInFront) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const tests::Volume v = tests::make_volume({49, 41, 57}, tests::Field::smooth);
  const scene::GridIndex voxels = v.grid.geometry.voxels();
  std::size_t crossings = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const std::vector<std::uint8_t> visible = random_cells(voxels, random);
    const ObjectSplit split(voxels, visible, 8, 2 + trial % 11);
    scene::Camera camera = tests::view("oblique");
    camera.position = {4 * uniform(random), 4 * uniform(random), 4 * uniform(random)};
    if (trial % 2 == 0) {
      camera.projection = scene::ProjectionKind::perspective;
      if (trial % 4 == 0) camera.position = {uniform(random), 0.8 * uniform(random), 0.6 * uniform(random)};  // inside
    }
    const std::vector<int> order = split.front_to_back(v.grid.geometry, camera);
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t n = 0; n < sorted.size(); ++n) ASSERT_EQ(sorted[n], static_cast<int>(n));
    const scene::ViewBasis basis = scene::view_basis(camera);
    for (int ray = 0; ray < 20; ++ray) {
      const double u = uniform(random), w = uniform(random);
      glm::dvec3 origin = camera.position, direction = basis.forward;
      if (camera.projection == scene::ProjectionKind::perspective)
        direction = glm::normalize(direction + basis.right * u + basis.up * w);
      else
        origin += basis.right * u + basis.up * w;
      std::ptrdiff_t last = -1;
      for (const int box : boxes_on(origin, direction, v.grid.geometry, split)) {
        const auto place = std::find(order.begin(), order.end(), box) - order.begin();
        EXPECT_GT(place, last) << "trial " << trial;
        last = place, ++crossings;
      }
    }
  }
  EXPECT_GT(crossings, 500u);
}

}  // namespace
}  // namespace tessera::object_split_test
