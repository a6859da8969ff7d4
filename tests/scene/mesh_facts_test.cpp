// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mesh_facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

#include "scene/threads.hpp"

namespace tessera::scene {
namespace {

/// Tets of very different sizes, anywhere, with -0 among the coordinates and scalars.
TetMesh scattered(std::size_t tets, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-100, 100), exponent(-12, 1);
  TetMesh mesh;
  for (std::size_t t = 0; t < tets; ++t) {
    const glm::dvec3 corner(place(random), place(random), t % 2 ? -0.0 : 0.0);
    const double size = std::exp2(exponent(random));
    const auto v = static_cast<std::uint32_t>(mesh.positions.size());
    for (const glm::dvec3 offset : {glm::dvec3(0, 0, 0), {1, 0, 0}, {0, 1, 0}, {0.3, 0.2, 1}}) {
      mesh.positions.push_back(corner + offset * size);
      if (offset.z == 0) mesh.positions.back().z = corner.z;  // a sum would lose the -0
      mesh.scalars.push_back(t % 2 ? -0.0 : size - size);
    }
    mesh.tets.push_back({v, v + 1, v + 2, v + 3});
  }
  return mesh;
}

MeshFacts facts_of_parts(const TetMesh& mesh, int parts, std::mt19937& random) {
  std::vector<TetMesh> part(static_cast<std::size_t>(parts), mesh);
  for (TetMesh& p : part) p.tets.clear();
  for (const Tet& tet : mesh.tets) part[random() % part.size()].tets.push_back(tet);
  MeshFacts facts;
  for (const TetMesh& p : part) facts = joined(facts, facts_of(p));
  VolumeSum volume = 0;
  for (const TetMesh& p : part) volume += volume_sum(p, facts.box);
  facts.mean_thickness = mean_thickness(facts.box, volume);
  return facts;
}

void expect_same_bits(const MeshFacts& a, const MeshFacts& b) {
  EXPECT_EQ(a, b);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.box.low[k]), std::bit_cast<std::uint64_t>(b.box.low[k]));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.box.high[k]), std::bit_cast<std::uint64_t>(b.box.high[k]));
  }
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.scalar_range[k]), std::bit_cast<std::uint64_t>(b.scalar_range[k]));
}

TEST(MeshFacts, NeitherOrderNorPartsChangeABit) {
  const TetMesh mesh = scattered(5000, 3);
  const MeshFacts whole = facts_of(mesh);
  EXPECT_GT(whole.mean_thickness, 0);
  EXPECT_EQ(whole.mean_thickness, mean_thickness(mesh));
  for (unsigned seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    TetMesh shuffled = mesh;
    std::shuffle(shuffled.tets.begin(), shuffled.tets.end(), random);
    expect_same_bits(facts_of(shuffled), whole);
    expect_same_bits(facts_of_parts(mesh, static_cast<int>(2 * seed), random), whole);
  }
}

TEST(MeshFacts, ThreadsChangeNoBit) {
  TetMesh mesh = scattered(50000, 6);  // several tasks
  for (const Association association : {Association::point, Association::cell}) {
    mesh.association = association;
    if (association == Association::cell) mesh.scalars.assign(mesh.tets.size(), 0.5), mesh.scalars[40000] = -3;
    const MeshFacts alone = with_threads(1, [&] { return facts_of(mesh); });
    for (const int threads : {0, 2, 3}) expect_same_bits(with_threads(threads, [&] { return facts_of(mesh); }), alone);
  }
  EXPECT_EQ(facts_of(mesh).scalar_range, (std::array<double, 2>{-3, 0.5}));
}

TEST(MeshFacts, TheVolumeIsTheSumOfTheTets) {
  const TetMesh mesh = scattered(2000, 4);
  const Box box = bounds(mesh);
  long double volume = 0;
  for (const Tet& t : mesh.tets) {
    const glm::dvec3 p = mesh.positions[t[1]] - mesh.positions[t[0]];
    volume += static_cast<long double>(p.x) * p.x * p.x / 6;  // scattered()'s tets are as high as wide
  }
  const glm::dvec3 s = box.high - box.low;
  const double face = std::max({s.x * s.y, s.y * s.z, s.z * s.x});
  // p.x is a difference of numbers of size 100, with an error of 1e-14. This is 6e-11 of the smallest p.x, 2^-12, and
  // three factors are multiplied.
  EXPECT_NEAR(mean_thickness(mesh) * face, static_cast<double>(volume), 3e-10 * static_cast<double>(volume));
}

TEST(MeshFacts, APartWithoutTetsChangesNothing) {
  const MeshFacts facts = facts_of(scattered(10, 5));
  EXPECT_EQ(joined(MeshFacts{}, facts), facts);
  EXPECT_EQ(joined(facts, MeshFacts{}), facts);
  EXPECT_EQ(facts_of({}), MeshFacts{});
}

}  // namespace
}  // namespace tessera::scene
