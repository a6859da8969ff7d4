// SPDX-License-Identifier: BSD-3-Clause
#include "cells/cell_split.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "cells/mesh_assembly.hpp"
#include "support/mesh_checks.hpp"

namespace tessera::io {
namespace {

using testing::count_triangles;
using testing::mixed_mesh;

bool on_box(const testing::TrianglePlace& t) {
  for (std::size_t a = 0; a < 3; ++a)
    for (const double wall : {0.0, 1.0})
      if (t[0][a] == wall && t[1][a] == wall && t[2][a] == wall) return true;
  return false;
}

/// Inside, every triangle belongs to two tets; on the box, to one. This is the meaning of "no gap, no overlap".
void expect_conforming(const scene::TetMesh& mesh) {
  for (const auto& [place, uses] : count_triangles(mesh)) EXPECT_EQ(uses, on_box(place) ? 1 : 2);
  // The cells tile the box, however warped the faces are. The tolerance is for rounding of about 1e4 determinants of
  // order 1e-3.
  EXPECT_NEAR(testing::volume(mesh), 1.0, 1e-12);
}

class Mixed : public ::testing::TestWithParam<unsigned> {};

TEST_P(Mixed, NeighboursAgreeOnEveryFace) {
  const cells::MeshFile file = cells::assemble_mesh({mixed_mesh(5, GetParam(), false)}, {}, "mesh");
  expect_conforming(file.mesh);
  EXPECT_EQ(file.counts.cells_tangled, 0u);
}

TEST_P(Mixed, NeighboursAgreeByPositionIfTheyShareNoIndex) {
  expect_conforming(cells::assemble_mesh({mixed_mesh(5, GetParam(), true)}, {}, "mesh").mesh);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Mixed, ::testing::Range(1u, 9u));

/// A prism over a regular polygon, divided into layers. Each layer is numbered from another corner.
TEST(SplitCell, PrismsOverPolygonsAgreeHoweverTheyAreNumbered) {
  std::mt19937 random(3);
  for (const int n : {5, 6})
    for (int round = 0; round < 20; ++round) {
      SCOPED_TRACE(::testing::Message() << n << " sides, round " << round);
      std::vector<glm::dvec3> points;
      constexpr int layers = 4;
      std::uniform_real_distribution<double> jitter(-0.2, 0.2);
      for (int layer = 0; layer <= layers; ++layer) {
        const double turn = jitter(random);
        for (int k = 0; k < n; ++k) {
          const double angle = turn + 2 * 3.141592653589793 * k / n;
          points.emplace_back(std::cos(angle), std::sin(angle), layer);
        }
      }
      scene::TetMesh mesh;
      for (int layer = 0; layer < layers; ++layer) {
        const int start = static_cast<int>(random() % static_cast<unsigned>(n)), flip = static_cast<int>(random() % 2);
        std::vector<std::uint32_t> corner;
        for (const int side : {flip, 1 - flip})
          for (int k = 0; k < n; ++k)
            corner.push_back(static_cast<std::uint32_t>((layer + side) * n + (start + k) % n));
        cells::split_cell(n == 5 ? cells::CellKind::pentagonal_prism : cells::CellKind::hexagonal_prism, corner, points,
                          mesh.tets);
      }
      mesh.positions = points;
      int boundary = 0;
      for (const auto& [place, uses] : count_triangles(mesh)) {
        EXPECT_LE(uses, 2);
        const bool end = (place[0][2] == 0 && place[1][2] == 0 && place[2][2] == 0) ||
                         (place[0][2] == layers && place[1][2] == layers && place[2][2] == layers);
        if (!end && place[0][2] == place[1][2] && place[1][2] == place[2][2]) {
          EXPECT_EQ(uses, 2);
        }
        boundary += uses == 1;
      }
      EXPECT_EQ(boundary, 2 * (n - 2) + 2 * n * layers);
      EXPECT_EQ(mesh.tets.size(), static_cast<std::size_t>(layers * (n == 5 ? 9 : 12)));
    }
}

TEST(SplitCell, AHexahedronWhoseFarCornerNoCutMeetsGivesFiveTets) {
  // A cube rotated so that the corners 0 2 5 7 are the smallest: x decides first.
  const std::vector<glm::dvec3> p = {{0, 0, 0},     {1, 0, 0.5}, {0.1, 1, 0}, {1, 1, 0.5},
                                     {1, 0.2, 1.2}, {0.2, 0, 1}, {1, 1, 1.2}, {0.3, 1, 1}};
  // Corners 0 (smallest), 2, 5, 7 have x of 0 to 0.3, the others 1: every cut connects two of the four.
  const std::vector<std::uint32_t> corner = {0, 1, 2, 3, 4, 5, 6, 7};
  std::vector<scene::Tet> tets;
  cells::split_cell(cells::CellKind::hexahedron, corner, p, tets);
  EXPECT_EQ(tets.size(), 5u);
}

TEST(SplitCell, CollapsedHexahedraAgreeWithTheirNeighbours) {
  // Cubes in a ring whose inner edge has length zero, each cell with its own points: a pole as in C-grids and O-grids.
  std::mt19937 random(11);
  constexpr int around = 7, up = 3;
  const auto place = [](int radius, int turn, int layer) {
    const double angle = 2 * 3.141592653589793 * (turn % around) / around;
    return glm::dvec3(radius * std::cos(angle), radius * std::sin(angle), layer);
  };
  cells::CellBlock block;
  block.offsets.push_back(0);
  for (int layer = 0; layer < up; ++layer)
    for (int radius = 0; radius < 2; ++radius)
      for (int turn = 0; turn < around; ++turn) {
        std::vector<glm::dvec3> c;
        for (const int k : {layer, layer + 1})
          for (const auto& [r, t] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
            c.push_back(place(radius + r, turn + t, k));
        const auto turns = static_cast<std::ptrdiff_t>(random() % 4);
        std::rotate(c.begin(), c.begin() + turns, c.begin() + 4);
        std::rotate(c.begin() + 4, c.begin() + 4 + turns, c.end());
        block.types.push_back(12);
        for (const glm::dvec3& p : c) {
          block.connectivity.push_back(static_cast<std::uint32_t>(block.positions.size()));
          block.positions.push_back(p);
        }
        block.offsets.push_back(block.connectivity.size());
      }
  const cells::MeshFile file = cells::assemble_mesh({block}, {}, "ring");
  EXPECT_GT(file.counts.tets_collapsed, 0u);
  int boundary = 0;
  for (const auto& [triangle, uses] : count_triangles(file.mesh)) {
    EXPECT_LE(uses, 2);
    boundary += uses == 1;
  }
  // Sides: 2 triangles per cell; top and bottom: 1 for the collapsed cells, 2 for the outer ones.
  EXPECT_EQ(boundary, 2 * around * up + 2 * around * 3);
  const double area = 0.5 * around * std::sin(2 * 3.141592653589793 / around) * 4;
  EXPECT_NEAR(testing::volume(file.mesh), area * up, 1e-12 * area * up);
}

TEST(CellShape, SupportsEveryVolumetricTypeAndRefusesTheRest) {
  EXPECT_EQ(cells::cell_shape(10).kind, cells::CellKind::tet);
  EXPECT_EQ(cells::cell_shape(25).corners, 8);
  EXPECT_TRUE(cells::cell_shape(25).higher_order);
  EXPECT_EQ(cells::cell_shape(5).kind, cells::CellKind::not_volumetric);
  EXPECT_EQ(cells::cell_shape(42).kind, cells::CellKind::polyhedron);
  EXPECT_EQ(cells::cell_shape(41).kind, cells::CellKind::convex_point_set);
  EXPECT_EQ(cells::cell_shape(255).kind, cells::CellKind::unsupported);
  EXPECT_EQ(cells::cell_type_name(42), "polyhedron");
}

}  // namespace
}  // namespace tessera::io
