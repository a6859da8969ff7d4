// SPDX-License-Identifier: BSD-3-Clause
// Positions of world points in the image, compared with the ray of that pixel.

#include "annotation/screen.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>
#include <random>

#include "annotation/small_pictures.hpp"

namespace tessera::annotation {
namespace {

/// A point on the ray through a pixel position, for a view as defined by VTK.
glm::dvec3 on_ray(const View& view, const glm::dvec2& pixel, double depth) {
  const ViewBasis basis = view_basis(view.camera);
  const double height = view.size.height, width = view.size.width;
  const double across = (pixel.x - width / 2) / (height / 2), up = (height / 2 - pixel.y) / (height / 2);
  const double half = view.camera.projection == ProjectionKind::perspective
                          ? depth * std::tan(view.camera.view_angle / 2 * std::numbers::pi / 180)
                          : view.camera.parallel_scale;
  return view.camera.position + basis.forward * depth + basis.right * (across * half) + basis.up * (up * half);
}

std::vector<View> random_views(int count) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto vector = [&] { return glm::dvec3(unit(random), unit(random), unit(random)); };
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    View view;
    const double size = std::pow(10, 20 * unit(random));
    view.camera.position = vector() * size;
    view.camera.focal_point = vector() * size;
    view.camera.view_up = vector();
    view.camera.projection = i % 2 == 0 ? ProjectionKind::orthographic : ProjectionKind::perspective;
    view.camera.parallel_scale = size * (0.1 + std::abs(unit(random)));
    view.camera.view_angle = 85 + 80 * unit(random);
    view.size = {1 + static_cast<int>(random() % 3000), 1 + static_cast<int>(random() % 3000)};
    views.push_back(view);
  }
  return views;
}

TEST(Screen, APointOfAPixelsRayIsAtThatPixel) {
  for (const View& view : random_views(500)) {
    const Screen screen(view);
    const double distance = glm::length(view.camera.focal_point - view.camera.position);
    for (const glm::dvec2& pixel : {glm::dvec2(0.5, 0.5), glm::dvec2(view.size.width - 0.5, 0.25), glm::dvec2(-30, 70)})
      for (const double depth : {0.01, 1.0, 100.0}) {
        const auto at = screen.pixel(on_ray(view, pixel, depth * distance));
        ASSERT_TRUE(at);
        // Doubles: positions have errors of 1e-16 of the largest distance, magnified 1e4 times by the smallest depth
        // and width.
        EXPECT_NEAR(at->x, pixel.x, 1e-7);
        EXPECT_NEAR(at->y, pixel.y, 1e-7);
      }
    EXPECT_FALSE(screen.pixel(on_ray(view, {1, 1}, -distance)));
  }
}

TEST(Screen, TheMiddleIsTheFocalPoint) {
  for (const View& view : random_views(100)) {
    const auto at = Screen(view).pixel(view.camera.focal_point);
    ASSERT_TRUE(at);
    EXPECT_NEAR(at->x, view.size.width / 2.0, 1e-9 * view.size.width);
    EXPECT_NEAR(at->y, view.size.height / 2.0, 1e-9 * view.size.height);
  }
}

TEST(Screen, AUnitAtTheFocalPointHasThatManyPixels) {
  for (const View& view : random_views(200)) {
    const Screen screen(view);
    const double pixels = screen.pixels_per_unit(), length = 0.3 * view.size.height / pixels;
    const auto from = screen.pixel(view.camera.focal_point);
    const auto to = screen.pixel(view.camera.focal_point + screen.basis().right * length);
    ASSERT_TRUE(from && to);
    EXPECT_NEAR(glm::length(*to - *from), 0.3 * view.size.height, 1e-6 * view.size.height);
  }
}

TEST(Screen, ALineIsCutWhereItLeavesThePictureAndBeforeTheEye) {
  const View view{perspective({0, 0, 10}, {}, 90), {200, 100}};
  const Screen screen(view);
  // Depth 10: the window is 20 high and 40 wide, 5 pixels a unit.
  const auto across = screen.segment({-1000, 1, 0}, {1000, 1, 0}, 4);
  ASSERT_TRUE(across);
  EXPECT_NEAR((*across)[0].x, -4, 1e-9);
  EXPECT_NEAR((*across)[1].x, 204, 1e-9);
  EXPECT_NEAR((*across)[0].y, 45, 1e-9);
  // The segment passes through the plane of the eye. Its part in front of the eye extends to the right without end.
  const auto towards = screen.segment({1, 0, 0}, {1, 0, 20}, 4);
  ASSERT_TRUE(towards);
  EXPECT_NEAR((*towards)[0].x, 105, 1e-9);
  EXPECT_NEAR((*towards)[1].x, 204, 1e-9);
  EXPECT_FALSE(screen.segment({1, 0, 11}, {1, 0, 20}, 4));
  EXPECT_FALSE(screen.segment({-1000, 100, 0}, {1000, 100, 0}, 4));
}

TEST(Screen, EdgesOfABoxAreBehindItIfBothFacesLookAway) {
  const Box box{{-1, -1, -1}, {1, 1, 1}};
  const auto behind = [&](const Camera& camera) {
    const Screen screen({camera, {100, 100}});
    int count = 0;
    for (const BoxEdge& edge : box_edges())
      if (faces_towards_eye(screen, box, edge) == 0) ++count;
    return count;
  };
  // Hidden edges: seen from a corner, three edges meet in the far corner; head on, in perspective, the far face has
  // four; from inside all are hidden.
  EXPECT_EQ(behind(orthographic({5, 4, 3}, {}, 1)), 3);
  EXPECT_EQ(behind(perspective({5, 4, 3}, {}, 30)), 3);
  EXPECT_EQ(behind(perspective({5, 4, 0}, {}, 30)), 5);
  EXPECT_EQ(behind(perspective({0.3, 0.2, 0.5}, {}, 30)), 12);
  EXPECT_EQ(behind(perspective({0, 0, 5}, {}, 30)), 8);
}

}  // namespace
}  // namespace tessera::annotation
