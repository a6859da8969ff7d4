// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/modify.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <set>

#include "datasets/boxes.hpp"
#include "datasets/conformity.hpp"
#include "datasets/shapes.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

TEST(Subdivided, KeepsVolumeOrientationFacesAndLinearFields) {
  scene::TetMesh mesh = cube(3);
  const auto linear = [](const glm::dvec3& p) { return 0.5 * p.x - 0.25 * p.y + 2 * p.z; };
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = linear(mesh.positions[v]);
  const scene::TetMesh fine = subdivided(mesh);
  ASSERT_EQ(fine.tets.size(), 8 * mesh.tets.size());
  ASSERT_NO_THROW(validate(fine, "fine"));
  for (std::size_t t = 0; t < fine.tets.size(); ++t)
    EXPECT_NEAR(signed_volume_6(fine, fine.tets[t]) / signed_volume_6(mesh, mesh.tets[t / 8]), 0.125, 1e-12);
  for (std::size_t v = 0; v < fine.positions.size(); ++v)
    EXPECT_NEAR(fine.scalars[v], linear(fine.positions[v]), 1e-14);
  const FaceCount before = count_faces(mesh), after = count_faces(fine);
  EXPECT_EQ(after.wrong, 0u);
  EXPECT_EQ(after.boundary, 4 * before.boundary);
  EXPECT_EQ(fine.positions.size(), 7u * 7 * 7);  // edge midpoints are merged
}

TEST(Subdivided, ChildrenInheritCellData) {
  const scene::TetMesh mesh = with_cell_data(cube(2)), fine = subdivided(mesh);
  ASSERT_EQ(fine.scalars.size(), fine.tets.size());
  for (std::size_t t = 0; t < fine.tets.size(); ++t) EXPECT_EQ(fine.scalars[t], mesh.scalars[t / 8]);
}

TEST(WithCellData, AveragesTheVerticesOfEachCell) {
  scene::TetMesh mesh = regular_split(2, 2, 2);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = mesh.positions[v].x;
  const scene::TetMesh cells = with_cell_data(mesh, 6);
  ASSERT_NO_THROW(validate(cells, "cells"));
  for (std::size_t t = 0; t < cells.tets.size(); ++t) {
    EXPECT_EQ(cells.original_cell[t], t / 6);
    EXPECT_DOUBLE_EQ(cells.scalars[t], t < 24 ? 0.125 : 0.375);  // x is the slowest index
  }
  EXPECT_THROW(with_cell_data(mesh, 5), scene::Error);
}

TEST(WithSeam, SplitsVerticesAndNothingElse) {
  const scene::TetMesh mesh = cube(4), seamed = with_seam(mesh, 0, 0.0);
  EXPECT_GT(seamed.positions.size(), mesh.positions.size());
  ASSERT_NO_THROW(validate(seamed, "seamed"));
  const auto by_index = [](const scene::TetMesh& m) {
    std::set<std::uint32_t> low, high;
    for (const scene::Tet& tet : m.tets) {
      double x = 0;
      for (const std::uint32_t v : tet) x += m.positions[v].x;
      (x < 0 ? low : high).insert(tet.begin(), tet.end());
    }
    std::size_t common = 0;
    for (const std::uint32_t v : low) common += high.count(v);
    return common;
  };
  EXPECT_GT(by_index(mesh), 0u);
  EXPECT_EQ(by_index(seamed), 0u);
  EXPECT_EQ(count_faces(seamed).boundary, count_faces(mesh).boundary);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(seamed.positions[seamed.tets[t][i]], mesh.positions[mesh.tets[t][i]]);
      EXPECT_EQ(seamed.scalars[seamed.tets[t][i]], mesh.scalars[mesh.tets[t][i]]);
    }
}

TEST(Shuffled, IsTheSameSetOfTets) {
  const scene::TetMesh mesh = with_cell_data(cube(3)), mixed = shuffled(mesh, 5);
  EXPECT_NE(mixed.tets, mesh.tets);
  const auto shape = [](const scene::TetMesh& m) {
    std::multiset<std::array<double, 4>> s;
    for (std::size_t t = 0; t < m.tets.size(); ++t) {
      const glm::dvec3 p = m.positions[m.tets[t][0]];
      s.insert({m.scalars[t], p.x, p.y, p.z});
    }
    return s;
  };
  EXPECT_EQ(shape(mixed), shape(mesh));
}

TEST(Parts, AreDisjointAndTogetherTheWhole) {
  const scene::TetMesh mesh = cube(4);
  for (const Partition way : {Partition::interleaved, Partition::random_blobs}) {
    const auto pieces = parts(mesh, 5, way, 3);
    ASSERT_EQ(pieces.size(), 5u);
    std::set<std::uint64_t> seen;
    double sum = 0;
    for (const scene::TetMesh& piece : pieces) {
      ASSERT_NO_THROW(validate(piece, "piece"));
      EXPECT_GT(piece.tets.size(), 0u);
      EXPECT_TRUE(std::is_sorted(piece.original_cell.begin(), piece.original_cell.end()));
      seen.insert(piece.original_cell.begin(), piece.original_cell.end());
      sum += volume(piece);
    }
    EXPECT_EQ(seen.size(), mesh.tets.size());
    EXPECT_NEAR(sum, 8, 1e-12);
    const scene::TetMesh whole = merged(pieces);
    ASSERT_NO_THROW(validate(whole, "whole"));
    EXPECT_EQ(count_faces(whole).boundary, count_faces(mesh).boundary);
  }
}

TEST(Inverted, TurnsAllOrEveryOtherTet) {
  const scene::TetMesh mesh = ball(1);
  EXPECT_NEAR(volume(inverted(mesh)), -volume(mesh), 1e-14);
  const scene::TetMesh mixed = inverted(mesh, Orientation::every_other_inverted);
  for (std::size_t t = 0; t < mixed.tets.size(); ++t) EXPECT_EQ(signed_volume_6(mixed, mixed.tets[t]) < 0, t % 2 == 0);
}

}  // namespace
}  // namespace tessera::datasets
