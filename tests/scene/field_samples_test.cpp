// SPDX-License-Identifier: BSD-3-Clause
#include "scene/field_samples.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "datasets/kuhn.hpp"

namespace tessera::scene {
namespace {

/// Six tets in each of 4 x 4 x 4 boxes; the field is x, from 0 to 1.
TetMesh boxes(glm::dvec3 size) {
  const datasets::Lattice lattice{4, 4, 4};
  TetMesh mesh;
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j)
      for (int k = 0; k <= 4; ++k) {
        mesh.positions.push_back(glm::dvec3(i, j, k) * 0.25 * size);
        mesh.scalars.push_back(i * 0.25);
      }
  mesh.tets = lattice.tets();
  return mesh;
}

// 2^14 samples are requested, plus one for each tet with a fractional share.
std::size_t most_samples(const TetMesh& mesh) { return (1 << 14) + mesh.tets.size(); }

TEST(FieldSamples, RepresentTheVolumeAndTheField) {
  const TetMesh mesh = boxes({1, 1, 1});
  const FieldSamples of = sample_mesh(mesh, {}, facts_of(mesh));
  EXPECT_GE(of.samples.size(), std::size_t{1} << 14);
  EXPECT_LE(of.samples.size(), most_samples(mesh));
  double volume = 0, moment = 0;
  for (const FieldSample& s : of.samples) {
    EXPECT_NEAR(s.value, s.at[0], 1e-6);  // positions are floats
    volume += double{s.volume}, moment += double{s.volume} * s.value;
  }
  EXPECT_NEAR(volume, 1, 1e-6);             // floats, each rounded by 6e-8
  EXPECT_NEAR(moment / volume, 0.5, 0.01);  // four times the expected error of as many random positions
}

// The tets' volumes, in cubes of the longest side, are too small for volume_sum() or values derived from it.
TEST(FieldSamples, AreBoundedForBoxesOfAnyShapeAndSize) {
  for (const glm::dvec3 size : {glm::dvec3(1, 1, 1e17),
                                {1, 1e14, 1},
                                {1e11, 1e-11, 1e11},
                                {1, 1e-30, 1e-30},
                                {1e-307, 1e-307, 1e-307},
                                {1e-320, 1e-310, 1e-315},
                                {1e100, 1e150, 1e60}}) {
    const TetMesh mesh = boxes(size);
    const FieldSamples of = sample_mesh(mesh, {}, facts_of(mesh));
    EXPECT_LE(of.samples.size(), most_samples(mesh)) << size.x << ' ' << size.y << ' ' << size.z;
  }
}

TEST(FieldSamples, OfPartsAreThoseOfTheWhole) {
  const TetMesh mesh = boxes({1, 1, 1e17});
  const MeshFacts facts = facts_of(mesh);
  const FieldSamples of = sample_mesh(mesh, {}, facts);
  ASSERT_FALSE(of.samples.empty());
  std::size_t together = 0;
  for (std::uint64_t part = 0; part < 3; ++part) {
    TetMesh own = mesh;
    own.tets.clear();
    std::vector<std::uint64_t> number;
    for (std::uint64_t t = part; t < mesh.tets.size(); t += 3) {
      own.tets.push_back(mesh.tets[t]);
      number.push_back(t);
    }
    together += sample_mesh(own, number, facts).samples.size();
  }
  EXPECT_EQ(together, of.samples.size());
}

}  // namespace
}  // namespace tessera::scene
