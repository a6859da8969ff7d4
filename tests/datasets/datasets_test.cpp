// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "datasets/boxes.hpp"
#include "datasets/conformity.hpp"
#include "datasets/demo.hpp"
#include "datasets/generate.hpp"
#include "datasets/shapes.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

const double pi = std::acos(-1.0);

/// Small instances of all kinds.
const std::map<std::string, std::map<std::string, double>> small{
    {"demo", {{"resolution", 0.3}}},
    {"cube", {{"n", 6}}},
    {"regular", {{"nx", 3}, {"ny", 4}, {"nz", 5}}},
    {"graded", {{"n", 6}}},
    {"slivers", {{"n", 5}}},
    {"stack", {{"layers", 50}}},
    {"ball", {{"levels", 2}}},
    {"annulus", {{"n", 24}}},
    {"shells", {{"levels", 2}}},
    {"bars", {{"n", 4}}},
    {"tet", {}},
};

TEST(Generators, EveryKindIsValidPositiveAndConforming) {
  for (const Generator& g : generators()) {
    SCOPED_TRACE(g.name);
    ASSERT_TRUE(small.contains(g.name)) << "add a small instance of the new kind to this test";
    const scene::TetMesh mesh = generate(g.name, small.at(g.name));
    ASSERT_NO_THROW(validate(mesh, g.name));
    ASSERT_FALSE(mesh.tets.empty());
    EXPECT_GT(smallest_volume(mesh), 0);
    const FaceCount faces = count_faces(mesh);
    EXPECT_EQ(faces.wrong, 0u);
    EXPECT_EQ(faces.boundary + 2 * faces.shared, 4 * mesh.tets.size());
    const auto [low, high] = scalar_range(mesh);
    EXPECT_GE(low, 0);
    EXPECT_LE(high, 1);
    EXPECT_GT(high - low, 0.3);
  }
}

TEST(Generators, TheSameArgumentsGiveTheSameBits) {
  for (const Generator& g : generators()) {
    SCOPED_TRACE(g.name);
    const scene::TetMesh a = generate(g.name, small.at(g.name)), b = generate(g.name, small.at(g.name));
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.tets, b.tets);
    EXPECT_EQ(a.scalars, b.scalars);
  }
  EXPECT_NE(cube(6, 0.2, 1).positions, cube(6, 0.2, 2).positions);
}

TEST(Generators, AreMeshesOfTheVolumeTheyClaim) {
  // Sums of thousands of volumes in double: 1e-12 is a thousand roundings.
  EXPECT_NEAR(volume(cube(10)), 8, 1e-12);
  EXPECT_EQ(volume(regular_split(2, 3, 4)), 2 * 3 * 4 / 64.0);  // dyadic, hence exact
  EXPECT_NEAR(volume(graded(8)), 8, 1e-12);
  EXPECT_NEAR(volume(slivers(6)), 8, 1e-12);
  EXPECT_NEAR(volume(single_tet()), 1.0 / 6, 1e-16);
  // Inscribed polyhedra: second order in the edge length, so twice the resolution has a quarter of the error.
  const double coarse = 4 * pi / 3 - volume(ball(2)), fine = 4 * pi / 3 - volume(ball(3));
  EXPECT_NEAR(coarse / fine, 4, 0.5);
  const double ring = pi * 0.75 * 0.5, loss = ring - volume(annulus(32)), less = ring - volume(annulus(64));
  EXPECT_NEAR(loss / less, 4, 0.1);
  const double wake = 13.0 * 6 * 3 - pi * 0.25 * 3;
  EXPECT_NEAR(volume(demo(0.5)), wake, 0.01);  // the cylinder is a polygon of 56 sides
}

TEST(Generators, CubeIsNeverTurnedInsideOutByItsJitter) {
  for (const int n : {2, 32}) EXPECT_GT(smallest_volume(cube(n)) * n * n * n, 0.02);
}

TEST(Generators, GradedHasTheVolumeRatioAskedFor) {
  const scene::TetMesh mesh = graded(16, 1e9);
  double least = 1e300, most = 0;
  for (const scene::Tet& tet : mesh.tets) {
    const double v = signed_volume_6(mesh, tet);
    least = std::min(least, v);
    most = std::max(most, v);
  }
  EXPECT_NEAR(most / least / 1e9, 1, 1e-6);
}

TEST(Generators, SliversAreFlatButHaveNoShortEdge) {
  const int n = 6;
  const double aspect = 1e6, edge = 2.0 / n;
  const scene::TetMesh mesh = slivers(n, aspect);
  ASSERT_EQ(mesh.tets.size(), 6u * 216 + 5 * 36);
  std::size_t flat = 0;
  for (const scene::Tet& tet : mesh.tets) {
    // A sliver's corners are those of a square bent by edge / aspect; six times its volume is edge^2 times the bend.
    if (signed_volume_6(mesh, tet) < 2 * edge * edge * edge / aspect) {
      ++flat;
      for (int a = 0; a < 4; ++a)
        for (int b = a + 1; b < 4; ++b)
          EXPECT_GT(glm::length(mesh.positions[tet[a]] - mesh.positions[tet[b]]), 0.99 * edge);
    }
  }
  EXPECT_EQ(flat, 5u * 36);
}

TEST(Generators, StackAndPlateAreApart) {
  const scene::TetMesh mesh = thin_stack(100);
  EXPECT_EQ(mesh.tets.size(), 6u * (100 + 60));
  // The stack and the plate have separate surfaces: the stack's ends and 8 triangles per layer, the plate's top, bottom
  // and sides.
  EXPECT_EQ(count_faces(mesh).boundary, (2 * 2 + 100 * 8u) + (60 * 2 * 2 + 4 * 8 * 2 + 8 * 2));
}

TEST(Generators, TheSeamHasVerticesOfItsOwnAndTheSameShape) {
  const scene::TetMesh closed = annulus(32), seamed = annulus(32, true);
  EXPECT_EQ(seamed.positions.size(), closed.positions.size() + 5 * 5);
  EXPECT_EQ(volume(seamed), volume(closed));
  EXPECT_EQ(count_faces(seamed).boundary, count_faces(closed).boundary);
}

TEST(Generate, ReportsErrorsAndListsTheKinds) {
  const auto message = [](const std::string& kind, const std::map<std::string, double>& parameters) -> std::string {
    try {
      generate(kind, parameters);
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.code(), scene::ErrorCode::bad_input);
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("cubes", {}).find("demo, cube, regular"), std::string::npos);
  EXPECT_NE(message("cube", {{"N", 3}}).find("n, jitter, seed"), std::string::npos);
  EXPECT_NE(message("cube", {{"n", 3.5}}).find("whole"), std::string::npos);
  EXPECT_NE(message("cube", {{"n", 1e9}}).find("1 .. 1000"), std::string::npos);
  EXPECT_NE(message("cube", {{"n", std::nan("")}}), "");
  EXPECT_NE(message("tet", {{"scale", 0}}), "");
}

TEST(Generate, CommonParametersChangeTheFinishedMesh) {
  const scene::TetMesh mesh =
      generate("cube", {{"n", 2}, {"cell_data", 6}, {"subdivide", 1}, {"scale", 1e-20}, {"inverted", 1}});
  EXPECT_EQ(mesh.tets.size(), 8u * 48);
  EXPECT_EQ(mesh.association, scene::Association::cell);
  EXPECT_NEAR(volume(mesh) * 1e60, -8, 1e-12);
}

}  // namespace
}  // namespace tessera::datasets
