// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tet_mesh.hpp"

#include <gtest/gtest.h>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

TetMesh corner_tet(const glm::dvec3& side) {
  TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {side.x, 0, 0}, {0, side.y, 0}, {0, 0, side.z}, {99, 99, 99}};  // the last is unused
  mesh.scalars = {1, 2, 3, 4, 99};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

TEST(TetMesh, BoundsAndRangeLeaveUnusedVerticesOut) {
  const TetMesh mesh = corner_tet({1, 2, 3});
  EXPECT_EQ(bounds(mesh).high, glm::dvec3(1, 2, 3));
  EXPECT_EQ(scalar_range(mesh), (std::array<double, 2>{1, 4}));
}

TEST(TetMesh, ThicknessIsVolumeOverTheLargestFaceAtAnyScale) {
  for (const double scale : {1.0, 1e-20, 1e20})
    EXPECT_NEAR(mean_thickness(corner_tet(glm::dvec3(6, 4, 0.5) * scale)) / scale, (6 * 4 * 0.5 / 6) / 24, 1e-15);
  EXPECT_EQ(mean_thickness(corner_tet({1, 1, 0})), 0);
  EXPECT_EQ(mean_thickness(TetMesh{}), 0);
}

TEST(TetMesh, ASubsetKeepsExactlyItsTets) {
  TetMesh mesh = corner_tet({1, 2, 3});
  mesh.positions.push_back({5, 5, 5});
  mesh.scalars.push_back(55);
  mesh.tets = {{0, 1, 2, 3}, {5, 1, 3, 2}, {3, 2, 1, 0}};
  mesh.original_cell = {7, 8, 9};
  const std::vector<std::uint32_t> second = {1};
  const TetMesh part = subset(mesh, second);
  EXPECT_EQ(part.positions, (std::vector<glm::dvec3>{{1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {5, 5, 5}}));
  EXPECT_EQ(part.scalars, (std::vector<double>{2, 3, 4, 55}));
  EXPECT_EQ(part.tets, (std::vector<Tet>{{3, 0, 2, 1}}));
  EXPECT_EQ(part.original_cell, (std::vector<std::uint64_t>{8}));
  mesh.association = Association::cell;
  mesh.scalars = {10, 20, 30};
  EXPECT_EQ(subset(mesh, std::vector<std::uint32_t>{2, 0}).scalars, (std::vector<double>{30, 10}));
  EXPECT_TRUE(subset(mesh, {}).positions.empty());
}

TEST(TetMesh, BrokenInvariantsAreNamedWithTheirPlace) {
  TetMesh mesh = corner_tet({1, 1, 1});
  EXPECT_NO_THROW(validate(mesh, "m.vtu"));
  mesh.tets[0][2] = 17;
  try {
    validate(mesh, "m.vtu");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("m.vtu: cell 0 uses vertex 17"), std::string::npos) << e.what();
  }
  mesh = corner_tet({1, 1, 1});
  mesh.scalars.pop_back();
  EXPECT_THROW(validate(mesh, "m.vtu"), Error);
}

}  // namespace
}  // namespace tessera::scene
