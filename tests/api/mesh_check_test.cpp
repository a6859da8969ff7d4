// SPDX-License-Identifier: BSD-3-Clause
#include "api/queries/mesh_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "datasets/boxes.hpp"
#include "datasets/modify.hpp"
#include "datasets/shapes.hpp"

namespace tessera::frame::mesh_check_test {
namespace {

TEST(MeshCheck, MeshesWhoseCellsMatchAreClean) {
  std::vector<scene::TetMesh> meshes;
  meshes.push_back(datasets::cube(5, 0.25));
  meshes.push_back(datasets::regular_split(4, 3, 2));
  meshes.push_back(datasets::ball(2));
  meshes.push_back(datasets::annulus(16, true));
  meshes.push_back(datasets::shells(3, 2, 2));
  meshes.push_back(datasets::cyclic_bars(4));
  meshes.push_back(datasets::graded(6, 1e6));
  meshes.push_back(datasets::inverted(datasets::cube(4), datasets::Orientation::every_other_inverted));
  meshes.push_back(datasets::shuffled(datasets::cube(4), 3));
  meshes.push_back(datasets::transformed(datasets::cube(3), 1e-20, glm::dvec3(0)));
  meshes.push_back(datasets::transformed(datasets::cube(3), 1e20, glm::dvec3(0)));
  meshes.push_back({});
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const MeshCheck check = api::check_mesh(meshes[i]);
    EXPECT_EQ(check.overlaps.count, 0u) << i;
    EXPECT_EQ(check.inverted.count, 0u) << i;
    EXPECT_EQ(check.non_conforming_faces.count, 0u) << i;
    EXPECT_EQ(check.left_handed + check.right_handed + check.flat.count, meshes[i].tets.size()) << i;
  }
}

TEST(MeshCheck, ReportsProgress) {
  std::vector<double> reported;
  api::check_mesh(datasets::cube(24), [&reported](double done) { reported.push_back(done); });
  ASSERT_GE(reported.size(), 6u);  // six parts, reported at each start and every 2^15 of 69,120 tets
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  EXPECT_GT(reported.front(), 0);
  EXPECT_LT(reported.back(), 1);
}

TEST(MeshCheck, CountsTwinsAlongASeam) {
  const scene::TetMesh whole = datasets::regular_split(4, 4, 4), cut = datasets::with_seam(whole, 0, 0.4);
  const MeshCheck check = api::check_mesh(cut);
  EXPECT_EQ(check.duplicate_points.count, cut.positions.size() - whole.positions.size());
  EXPECT_GT(check.duplicate_points.count, 0u);
  EXPECT_TRUE(check.clean());
}

TEST(MeshCheck, MeasuresSlivers) {
  const MeshCheck check = api::check_mesh(datasets::slivers(3, 1e5));
  EXPECT_EQ(check.slivers.count, 2u * 9);
  EXPECT_EQ(check.slivers_1e4, 2u * 9);
  EXPECT_EQ(check.slivers_1e6, 0u);
  EXPECT_GT(check.worst_aspect, 5e4);
  EXPECT_LT(check.worst_aspect, 1e6);
  EXPECT_EQ(check.slivers.places.front().value, check.worst_aspect);
}

/// Pairs of tets with a common volume, found by points sampled in all of them.
TEST(MeshCheck, FindsAllPairsOfTwoMeshesThatPassThroughEachOther) {
  const scene::TetMesh one = datasets::cube(3, 0.2),
                       other = datasets::transformed(datasets::cube(2, 0.2, 9), 0.4, {0.9, 0.8, 0});
  const scene::TetMesh both = datasets::merged({one, other});
  const MeshCheck check = api::check_mesh(both);
  EXPECT_EQ(check.inverted.count, 0u);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const auto inside = [&](std::size_t t, const glm::dvec3& p) {
    const auto volume = [](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d) {
      return (b.x - a.x) * ((c.y - a.y) * (d.z - a.z) - (c.z - a.z) * (d.y - a.y)) -
             (b.y - a.y) * ((c.x - a.x) * (d.z - a.z) - (c.z - a.z) * (d.x - a.x)) +
             (b.z - a.z) * ((c.x - a.x) * (d.y - a.y) - (c.y - a.y) * (d.x - a.x));
    };
    const scene::Tet& v = both.tets[t];
    const auto& q = both.positions;
    const double whole = volume(q[v[0]], q[v[1]], q[v[2]], q[v[3]]);
    return volume(p, q[v[1]], q[v[2]], q[v[3]]) / whole > 1e-3 && volume(q[v[0]], p, q[v[2]], q[v[3]]) / whole > 1e-3 &&
           volume(q[v[0]], q[v[1]], p, q[v[3]]) / whole > 1e-3 && volume(q[v[0]], q[v[1]], q[v[2]], p) / whole > 1e-3;
  };
  for (std::size_t b = one.tets.size(); b < both.tets.size(); ++b)
    for (int i = 1; i < 10; ++i)
      for (int k = 1; i + k < 10; ++k)
        for (int l = 1; i + k + l < 10; ++l) {
          const double w[4] = {i / 10., k / 10., l / 10., 1 - (i + k + l) / 10.};
          glm::dvec3 p(0);
          for (std::size_t c = 0; c < 4; ++c) p += w[c] * both.positions[both.tets[b][c]];
          for (std::size_t a = 0; a < one.tets.size(); ++a)
            if (inside(a, p)) pairs.emplace_back(a, b);
        }
  std::sort(pairs.begin(), pairs.end());
  const auto sampled = static_cast<std::size_t>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
  EXPECT_GT(sampled, 50u);
  EXPECT_GE(check.overlaps.count, sampled);  // samples miss small overlaps
  EXPECT_LE(check.overlaps.count, 3 * sampled);
}

TEST(MeshCheck, FindsABodyWithinAnother) {
  const scene::TetMesh both = datasets::merged({datasets::regular_split(1, 1, 1, glm::dvec3(2), glm::dvec3(-1)),
                                                datasets::transformed(datasets::cube(4), 0.1, {0.05, 0.03, 0.02})});
  const MeshCheck check = api::check_mesh(both);
  // Every small cell overlaps at least one of the six large ones.
  EXPECT_GE(check.overlaps.count, 6u * 64);
  EXPECT_GE(check.overlapping_cells, 6u * 64 + 2);
}

TEST(MeshCheck, AVertexPushedThroughAFaceIsAFoldAndCellsOverlap) {
  scene::TetMesh mesh = datasets::regular_split(2, 2, 2);
  EXPECT_TRUE(api::check_mesh(mesh).clean());
  // Moves the vertex in the middle beyond the next vertex along x.
  for (glm::dvec3& p : mesh.positions)
    if (p == glm::dvec3(0.25)) p.x += 0.3;
  const MeshCheck check = api::check_mesh(mesh);
  EXPECT_GT(check.inverted.count, 0u);
  EXPECT_GT(check.overlaps.count, 0u);
  EXPECT_FALSE(check.clean());
}

TEST(MeshCheck, TheSameCellTwiceOverlapsItself) {
  const MeshCheck check = api::check_mesh(datasets::merged({datasets::cube(2), datasets::cube(2)}));
  EXPECT_EQ(check.duplicate_points.count, 27u);
  EXPECT_EQ(check.overlaps.count, 48u);
  EXPECT_EQ(check.overlapping_cells, 96u);
}

TEST(MeshCheck, CellsOfSeveralTetsAreCountedAndListedOncePerPair) {
  // Two voxels of six tets each, one moved by half a side into the other, and a separate third one.
  scene::TetMesh mesh = datasets::merged({datasets::regular_split(1, 1, 1, glm::dvec3(1)),
                                          datasets::regular_split(1, 1, 1, glm::dvec3(1), {0.5, 0.25, 0.125}),
                                          datasets::regular_split(1, 1, 1, glm::dvec3(1), {5, 0, 0})});
  ASSERT_EQ(mesh.tets.size(), 18u);
  for (std::size_t t = 0; t < 18; ++t) mesh.original_cell.push_back(40 - t / 6);
  const MeshCheck check = api::check_mesh(mesh);
  EXPECT_EQ(check.overlaps.count, 1u);
  EXPECT_EQ(check.overlapping_cells, 2u);
  ASSERT_EQ(check.overlaps.places.size(), 1u);
  EXPECT_EQ(check.overlaps.places[0].cell, 39u);
  EXPECT_EQ(check.overlaps.places[0].other, 40u);
}

TEST(MeshCheck, ACellWhoseOwnTetsOverlapIsAPairWithItself) {
  scene::TetMesh mesh = datasets::regular_split(1, 1, 1, glm::dvec3(1));
  mesh.original_cell.assign(mesh.tets.size(), 7);
  // Moves a corner through the cell and out of its other side.
  for (glm::dvec3& p : mesh.positions)
    if (p == glm::dvec3(1, 0, 0)) p = {-0.5, 1.25, 1.5};
  const MeshCheck check = api::check_mesh(mesh);
  EXPECT_EQ(check.overlaps.count, 1u);
  EXPECT_EQ(check.overlapping_cells, 1u);
  ASSERT_EQ(check.overlaps.places.size(), 1u);
  EXPECT_EQ(check.overlaps.places[0].other, 7u);
  EXPECT_EQ(check.inverted.places.size(), 1u);
}

TEST(MeshCheck, FindsHangingNodesAndDiagonalsThatDoNotMatch) {
  // One large voxel next to 2 x 2 x 2 small ones: two faces against eight.
  const scene::TetMesh hanging = datasets::merged(
      {datasets::regular_split(1, 1, 1, glm::dvec3(0.5), {-0.5, 0, 0}), datasets::regular_split(2, 2, 2)});
  EXPECT_EQ(api::check_mesh(hanging).non_conforming_faces.count, 2u + 8);
  EXPECT_EQ(api::check_mesh(hanging).overlaps.count, 0u);
  scene::TetMesh mirrored = datasets::regular_split(1, 1, 1, glm::dvec3(0.5), {-0.5, 0, 0});
  for (glm::dvec3& p : mirrored.positions) p.y = 0.5 - p.y;
  const scene::TetMesh diagonals = datasets::merged({mirrored, datasets::regular_split(1, 1, 1, glm::dvec3(0.5))});
  EXPECT_EQ(api::check_mesh(diagonals).non_conforming_faces.count, 4u);
}

}  // namespace
}  // namespace tessera::frame::mesh_check_test
