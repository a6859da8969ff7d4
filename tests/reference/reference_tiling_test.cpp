// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"

namespace tessera::reference::reference_tiling_test {
namespace {

using scene::ProjectionKind;
using scene::TransferFunction;

const TransferFunction grey({{0, {0.5, 0.5, 0.5}, 1}});
double any_field(const glm::dvec3& p) { return p.x + 2 * p.y - 0.5 * p.z; }

/// The tets in which a ray's path is longer than a fiftieth of a unit. This excludes tets that a small shift of the ray
/// adds.
std::set<std::size_t> cells_of(const std::vector<RaySegment>& segments) {
  std::set<std::size_t> cells;
  for (const RaySegment& s : segments)
    if (s.length > 0.02) cells.insert(s.tet);
  return cells;
}

/// The six views along an axis of the box [0, 4]^3 whose vertices are exactly on pixel centres, every second pixel.
std::vector<scene::Camera> axis_views() {
  std::vector<scene::Camera> views;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      glm::dvec3 direction(0), up(0);
      direction[axis] = side;
      up[(axis + 1) % 3] = 1;
      // Two pixels a unit, 12 pixels high; the middle of the box is a quarter unit away from the middle of the window.
      scene::Camera camera = looking({0, 0, 0}, direction, ProjectionKind::orthographic, 3, up);
      const scene::ViewBasis basis = scene::view_basis(camera);
      const glm::dvec3 middle = glm::dvec3(2, 2, 2) + 0.25 * basis.right + 0.25 * basis.up;
      camera.position = middle - 7.0 * direction;
      camera.focal_point = middle;
      views.push_back(camera);
    }
  return views;
}

TEST(ReferenceTiling, RaysThroughVerticesEdgesAndFacesFollowTheTieRule) {
  const scene::TetMesh mesh = box_of_tets(4, {0, 0, 0}, {4, 4, 4}, any_field);
  for (const scene::Camera& camera : axis_views()) {
    const Reference reference(mesh, camera, {12, 12}, grey);
    int hits = 0;
    for (const PixelIndex& p : all_pixels({12, 12})) {
      const double x = p.x + 0.5, y = p.y + 0.5;
      const std::vector<RaySegment> segments = reference.segments(x, y);
      // The box covers pixel coordinates from 1.5 (x) and 2.5 (y) on, 8 pixels wide. The ray shifted by (e, e^2) is
      // inside if it is on the low sides, outside if on the high sides.
      const bool inside = x >= 1.5 && x < 9.5 && y >= 2.5 && y < 10.5;
      ASSERT_EQ(!segments.empty(), inside) << p.x << ' ' << p.y;
      if (!inside) continue;
      ++hits;
      double depth = 5;
      for (const RaySegment& s : segments) {
        ASSERT_EQ(s.front, depth);
        depth = s.back;
      }
      ASSERT_EQ(depth, 9);
      // The cells are those of a ray that is actually shifted, by a small amount.
      ASSERT_EQ(cells_of(segments), cells_of(reference.segments(x + 1e-4, y + 1e-8)));
    }
    EXPECT_EQ(hits, 64);
  }
}

TEST(ReferenceTiling, PerspectiveRayAlongALineOfEdgesIsWhole) {
  const scene::TetMesh mesh = box_of_tets(4, {-1, -1, -1}, {1, 1, 1}, any_field);
  for (const double distance : {5.0, 0.5, 0.25}) {
    // Odd sides: the middle pixel's centre is on the view axis, which contains edges.
    const scene::Camera camera = looking({0, 0, distance}, {0, 0, -1}, ProjectionKind::perspective, 30);
    const Reference reference(mesh, camera, {9, 9}, grey);
    const std::vector<RaySegment> segments = reference.segments(4.5, 4.5);
    ASSERT_FALSE(segments.empty());
    double depth = std::max(0.0, distance - 1);
    for (const RaySegment& s : segments) {
      EXPECT_DOUBLE_EQ(s.front, depth);
      depth = s.back;
    }
    EXPECT_EQ(depth, distance + 1);
    EXPECT_EQ(cells_of(segments), cells_of(reference.segments(4.5001, 4.50000001)));
  }
}

TEST(ReferenceTiling, SegmentsOfAConvexMeshTouchEndToEnd) {
  const glm::dvec3 low(-1, -1, -1), high(1, 1, 1);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const scene::TetMesh mesh = box_of_tets(6, low, high, any_field, 0.15, seed);
    for (const scene::Camera& camera : {looking({3, 4, 5}, {0.1, 0, 0}, ProjectionKind::orthographic, 1.8),
                                        looking({3, 4, 5}, {0.1, 0, 0}, ProjectionKind::perspective, 25),
                                        looking({0.13, 0.21, -0.37}, {2, 1, 0.3}, ProjectionKind::perspective, 110)}) {
      const Reference reference(mesh, camera, {32, 32}, grey);
      for (const PixelIndex& p : all_pixels({32, 32})) {
        const std::vector<RaySegment> segments = reference.segments(p.x + 0.5, p.y + 0.5);
        const DepthRange range = depths_in_box(world_ray(camera, {32, 32}, p.x + 0.5, p.y + 0.5), low, high);
        if (range.size() < 1e-12) continue;
        ASSERT_FALSE(segments.empty());
        // The box itself moves by the rounding of vertices, 2^-33 pixel or 1e-11 units, times its faces' slant.
        ASSERT_NEAR(segments.front().front, range.low, 2e-10);
        double depth = segments.front().front, scalar = segments.front().scalar_front;
        for (const RaySegment& s : segments) {
          ASSERT_NEAR(s.front, depth, 1e-12) << "seed " << seed;
          ASSERT_NEAR(s.scalar_front, scalar, 1e-12) << "seed " << seed;
          depth = s.back, scalar = s.scalar_back;
        }
        ASSERT_NEAR(depth, range.high, 2e-10);
      }
    }
  }
}

TEST(ReferenceTiling, FlatCellsAreKeptWithNoLength) {
  scene::TetMesh mesh = box_of_tets(1, {0, 0, 0}, {1, 1, 1}, any_field);
  const std::size_t cells = mesh.tets.size();
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  // A flat quadrangle of one tet across the box, and a tet with two coincident vertices.
  for (const glm::dvec3& p : {glm::dvec3(0, 0, 0.5), {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}, {0, 0, 0.5}})
    mesh.positions.push_back(p), mesh.scalars.push_back(any_field(p));
  mesh.tets.push_back({first, first + 1, first + 2, first + 3});
  mesh.tets.push_back({first, first + 4, first + 1, first + 2});
  const Reference reference(mesh, looking({0.5, 0.5, 3}, {0.5, 0.5, 0}, ProjectionKind::orthographic, 0.5), {16, 16},
                            grey);
  std::size_t flat = 0;
  for (const PixelIndex& p : all_pixels({16, 16})) {
    double length = 0;
    for (const RaySegment& s : reference.segments(p.x + 0.5, p.y + 0.5)) {
      length += s.length;
      if (s.tet < cells) continue;
      EXPECT_EQ(s.length, 0);
      EXPECT_EQ(s.front, 2.5);
      ++flat;
    }
    EXPECT_DOUBLE_EQ(length, 1);
  }
  EXPECT_EQ(flat, 256u + 136u);  // the sixteen rays of the diagonal, shifted to the right, are in this half
}

TEST(ReferenceTiling, WarpedAndFlattenedMeshesStillTile) {
  // Cells flattened 10,000 : 1 and seen at a grazing angle.
  const glm::dvec3 low(-1, -1, -1e-4), high(1, 1, 1e-4);
  const scene::TetMesh mesh = box_of_tets(5, low, high, any_field, 0.15);
  const scene::Camera camera = looking({3, 0.7, 0.05}, {0, 0, 0}, ProjectionKind::orthographic, 0.02, {0, 0, 1});
  const Reference reference(mesh, camera, {64, 64}, grey);
  int hits = 0;
  for (const PixelIndex& p : all_pixels({64, 64})) {
    const DepthRange range = depths_in_box(world_ray(camera, {64, 64}, p.x + 0.5, p.y + 0.5), low, high);
    const Pixel found = reference.pixel(p.x + 0.5, p.y + 0.5);
    // Vertices are rounded by 2^-33 pixel, here 7e-14 world units across, which the grazing angle (1 : 62) magnifies.
    EXPECT_NEAR(found.length, range.size(), 1e-10);
    hits += range.size() > 0;
  }
  EXPECT_GT(hits, 200);
}

}  // namespace
}  // namespace tessera::reference::reference_tiling_test
