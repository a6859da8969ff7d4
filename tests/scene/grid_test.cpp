// SPDX-License-Identifier: BSD-3-Clause
#include "scene/grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

GridGeometry turned() {
  GridGeometry g;
  g.points = {5, 4, 3};
  g.origin = {100, -20, 7};
  g.direction = {{0, 1, 0}, {-1, 0, 0}, {0, 0, -1}};  // x to y, y to -x, z mirrored: left-handed
  g.spacing = {0.5, 2, 3};
  return g;
}

GridGeometry stretched() {
  GridGeometry g;
  g.points = {4, 3, 2};
  g.coordinates = {std::vector<double>{-1, 0, 4, 5}, std::vector<double>{0, 1, 10}, std::vector<double>{2, 3}};
  return g;
}

TEST(Grid, IndexAndWorldAreInverseInsideAndOutside) {
  for (const GridGeometry& g : {turned(), stretched()})
    for (const glm::dvec3 index : {glm::dvec3(0), glm::dvec3(1.5, 0.25, 0.75), glm::dvec3(-2, 5, 3)}) {
      const glm::dvec3 back = index_of_world(g, world_of_index(g, index));
      EXPECT_LT(glm::length(back - index), 1e-12);  // a few roundings of numbers up to 100
    }
}

TEST(Grid, LatticePointsFollowAxesAndSpacing) {
  EXPECT_EQ(world_of_index(turned(), {2, 1, 1}), glm::dvec3(100 - 2, -20 + 1, 7 - 3));
  EXPECT_EQ(world_of_index(stretched(), {1.25, 1.5, 0}), glm::dvec3(1, 5.5, 2));
  EXPECT_EQ(bounds(turned()), (Box{{94, -20, 1}, {100, -18, 7}}));
  EXPECT_EQ(bounds(stretched()), (Box{{-1, 0, 2}, {5, 10, 3}}));
}

TEST(Grid, CellDataHasASampleLessAlongEachAxis) {
  GridGeometry g = turned();
  EXPECT_EQ(g.samples(), (GridIndex{5, 4, 3}));
  g.association = Association::cell;
  EXPECT_EQ(g.samples(), (GridIndex{4, 3, 2}));
  EXPECT_EQ(g.voxels(), (GridIndex{4, 3, 2}));
}

TEST(Grid, ThicknessIsVolumeOverTheLargestFaceAtAnyScale) {
  for (const double scale : {1e-120, 1.0, 1e120}) {
    GridGeometry g;
    g.points = {3, 3, 3};
    g.spacing = glm::dvec3(1, 2, 3) * scale;
    EXPECT_NEAR(mean_thickness(g) / scale, 2, 1e-14);
  }
}

TEST(Grid, SizesOf2048CubedAndMoreAreCountedRight) {
  GridGeometry g;
  g.points = {2048, 2048, 2048};
  EXPECT_EQ(g.all_samples().count(), std::int64_t{1} << 33);
  EXPECT_NO_THROW(validate(Grid{.geometry = g}, "v"));
}

TEST(Grid, BrokenInvariantsAreNamedWithTheirAxis) {
  const auto message = [](const std::function<void(Grid&)>& spoil) {
    Grid grid{.geometry = stretched()};
    spoil(grid);
    try {
      validate(grid, "v.vti");
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::bad_input);
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message([](Grid&) {}), "");
  EXPECT_NE(message([](Grid& g) { g.geometry = turned(), g.geometry.points[1] = 1; }).find("1 point along y"),
            std::string::npos);
  EXPECT_NE(message([](Grid& g) { g.geometry.coordinates[0][2] = -5; }).find("coordinate 2 along x"),
            std::string::npos);
  EXPECT_NE(message([](Grid& g) { g.geometry.coordinates[2].clear(), g.geometry.spacing.z = 0; }).find("along z"),
            std::string::npos);
  EXPECT_NE(message([](Grid& g) { g.geometry.direction[1] = {1, 0, 0}; }).find("one plane"), std::string::npos);
  EXPECT_NE(message([](Grid& g) { g.geometry.direction[1] = {0, 2, 0}; }).find("length one"), std::string::npos);
  EXPECT_NE(message([](Grid& g) { g.geometry.origin.x = std::nan(""); }).find("origin"), std::string::npos);
  EXPECT_NE(message([](Grid& g) { g.scale = 0; }).find("scaled by 0"), std::string::npos);
  EXPECT_NE(message([](Grid& g) {
              g.geometry = turned(), g.geometry.points.fill(std::int64_t{1} << 21);
            }).find("than can be addressed"),
            std::string::npos);
}

}  // namespace
}  // namespace tessera::scene
