// SPDX-License-Identifier: BSD-3-Clause
#include "projection/prepared_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <tuple>

#include "datasets/boxes.hpp"

namespace tessera::projection::prepared_mesh_test {
namespace {

/// A cube's tets with shuffled corners, and some vertices twice.
scene::TetMesh shuffled_corners() {
  scene::TetMesh mesh = datasets::cube(12, 0.2);
  std::mt19937 random(1);
  const std::size_t vertices = mesh.positions.size();
  for (std::size_t v = 0; v < vertices; v += 3) {
    mesh.positions.push_back(mesh.positions[v]);
    mesh.scalars.push_back(mesh.scalars[v]);
  }
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::shuffle(mesh.tets[t].begin(), mesh.tets[t].end(), random);
    for (std::uint32_t& v : mesh.tets[t])
      if (t % 2 == 0 && v % 3 == 0) v = static_cast<std::uint32_t>(vertices) + v / 3;
  }
  return mesh;
}

void expect_canonical(std::span<const scene::Tet> tets, const scene::TetMesh& original) {
  ASSERT_EQ(tets.size(), original.tets.size());
  const auto key = [&](std::uint32_t v) {
    const glm::dvec3& p = original.positions[v];
    return std::tuple(p.x, p.y, p.z, v);
  };
  for (std::size_t t = 0; t < tets.size(); ++t) {
    EXPECT_TRUE(std::is_permutation(tets[t].begin(), tets[t].end(), original.tets[t].begin())) << t;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LE(key(tets[t][i]), key(tets[t][i + 1])) << t;
  }
}

TEST(PreparedMesh, CornersAreInCanonicalOrder) {
  const scene::TetMesh mesh = shuffled_corners();
  PreparedMesh prepared(mesh);
  expect_canonical(prepared.tets(), mesh);
  const PreparedMesh moved = std::move(prepared);
  expect_canonical(moved.tets(), mesh);
}

TEST(PreparedMesh, AnOrderedMeshIsNotCopied) {
  const scene::TetMesh mesh = shuffled_corners();
  scene::TetMesh ordered = mesh;
  order_corners(ordered);
  expect_canonical(ordered.tets, mesh);
  EXPECT_EQ(PreparedMesh(ordered).tets().data(), ordered.tets.data());
  // One corner out of order, in the last tet, is detected.
  std::swap(ordered.tets.back()[2], ordered.tets.back()[3]);
  const PreparedMesh prepared(ordered);
  EXPECT_NE(prepared.tets().data(), ordered.tets.data());
  expect_canonical(prepared.tets(), mesh);
}

}  // namespace
}  // namespace tessera::projection::prepared_mesh_test
