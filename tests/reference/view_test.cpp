// SPDX-License-Identifier: BSD-3-Clause
#include "reference/view.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/small_meshes.hpp"

namespace tessera::reference::view_test {
namespace {

using scene::ProjectionKind;

TEST(View, OrthographicPixelsHaveYDownAndTheTopLeftAtZero) {
  const View view(looking({0, 0, 10}, {0, 0, 0}, ProjectionKind::orthographic, 2), {200, 100});
  const ProjectedVertex top_left = view.project({-4, 2, 3});
  EXPECT_EQ(top_left.homogeneous, glm::dvec3(0, 0, 1));
  EXPECT_EQ(top_left.depth, 7);
  EXPECT_EQ(view.project({4, -2, 0}).homogeneous, glm::dvec3(200, 100, 1));
}

TEST(View, DecimalNoiseOfTheCameraIsRoundedAway) {
  // 0.1 + 0.2 is not 0.3 in doubles, but on the pixel grid it is.
  const View view(looking({0.1 + 0.2, 0, 10}, {0.1 + 0.2, 0, 0}, ProjectionKind::orthographic, 1), {100, 100});
  EXPECT_EQ(view.project({0.3, 0, 0}).homogeneous.x, 50);
}

TEST(View, DecimalNoiseOfPerspectiveIsRoundedAwayAllAroundTheEye) {
  const View view(looking({0.1, 0.2, 0.3}, {0.4, 0.9, -0.7}, ProjectionKind::perspective, 40, {0.1, 1, 0.2}),
                  {101, 61});
  const double per_tangent = 30.5 / std::tan(20 * std::acos(-1.0) / 180);
  const scene::ViewBasis basis =
      scene::view_basis(looking({0.1, 0.2, 0.3}, {0.4, 0.9, -0.7}, ProjectionKind::perspective, 40, {0.1, 1, 0.2}));
  for (const double depth : {0.7, 3.1, -0.4, -11.0})
    for (const double y : {3.5, 17.25, -40.5}) {
      const double x = 70.5, across = (x - 50.5) / per_tangent, upward = (30.5 - y) / per_tangent;
      const glm::dvec3 p =
          glm::dvec3(0.1, 0.2, 0.3) + depth * (basis.forward + across * basis.right + upward * basis.up);
      const double side = depth > 0 ? 1 : -1;
      EXPECT_EQ(view.project(p).sight, glm::dvec3(side * x, side * y, side));
    }
  // A point above the eye is in the plane of the eye and in the planes of all columns; a point to its left is in the
  // planes of all rows.
  EXPECT_EQ(view.project(glm::dvec3(0.1, 0.2, 0.3) + 0.7 * basis.up).sight.x, 0);
  EXPECT_EQ(view.project(glm::dvec3(0.1, 0.2, 0.3) + 0.7 * basis.up).sight.z, 0);
  EXPECT_EQ(view.project(glm::dvec3(0.1, 0.2, 0.3) - 0.3 * basis.right).sight.y, 0);
  EXPECT_EQ(view.project({0.1, 0.2, 0.3}).sight, glm::dvec3(0, 0, 0));
}

TEST(View, PerspectiveAngleSpansTheHeight) {
  const View view(looking({0, 0, 10}, {0, 0, 0}, ProjectionKind::perspective, 90), {100, 100});
  for (const double depth : {1.0, 7.0, -2.0}) {
    const glm::dvec3 h = view.project({0, depth, 10 - depth}).homogeneous;  // 45 degrees above the view direction
    EXPECT_EQ(h.z, depth);
    EXPECT_NEAR(h.y / h.z, 0, 1e-12);
    EXPECT_NEAR(h.x / h.z, 50, 1e-12);
  }
  EXPECT_NEAR(view.length_per_depth(100, 50), std::sqrt(2.0), 1e-14);
  EXPECT_EQ(view.length_per_depth(50, 50), 1);
}

}  // namespace
}  // namespace tessera::reference::view_test
