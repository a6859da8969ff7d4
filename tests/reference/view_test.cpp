#include "reference/view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "small_meshes.hpp"

namespace tessera::reference {
namespace {

using scene::ProjectionKind;

TEST(View, OrthographicPixelsHaveYDownAndTheTopLeftAtZero) {
  const View view(looking({0, 0, 10}, {0, 0, 0}, ProjectionKind::orthographic, 2), {200, 100});
  const ProjectedVertex top_left = view.project({-4, 2, 3});
  EXPECT_EQ(top_left.sight, glm::dvec3(0, 0, 1));
  EXPECT_EQ(top_left.depth, 7);
  EXPECT_EQ(view.project({4, -2, 0}).sight, glm::dvec3(200, 100, 1));
}

TEST(View, DecimalNoiseOfTheCameraIsRoundedAway) {
  // 0.1 + 0.2 is not 0.3 in doubles; on the pixel grid it is.
  const View view(looking({0.1 + 0.2, 0, 10}, {0.1 + 0.2, 0, 0}, ProjectionKind::orthographic, 1), {100, 100});
  EXPECT_EQ(view.project({0.3, 0, 0}).sight.x, 50);
}

TEST(View, PerspectiveAngleSpansTheHeight) {
  const View view(looking({0, 0, 10}, {0, 0, 0}, ProjectionKind::perspective, 90), {100, 100});
  for (const double depth : {1.0, 7.0, -2.0}) {
    const ProjectedVertex v = view.project({0, depth, 10 - depth});  // 45 degrees above the view direction
    EXPECT_EQ(v.scale * v.sight.z, depth);
    EXPECT_EQ(v.sight.y / v.sight.z, 0);
    EXPECT_EQ(v.sight.x / v.sight.z, 50);
  }
  EXPECT_NEAR(view.length_per_depth(100, 50), std::sqrt(2.0), 1e-14);
  EXPECT_EQ(view.length_per_depth(50, 50), 1);
}

}  // namespace
}  // namespace tessera::reference
