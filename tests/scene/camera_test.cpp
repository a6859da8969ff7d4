// SPDX-License-Identifier: BSD-3-Clause
#include "scene/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "scene/error.hpp"
#include "tessera/default_view.hpp"

namespace tessera::scene {
namespace {

TEST(Camera, AxisAlignedViewGivesExactUnitVectors) {
  Camera camera;
  camera.position = {0.25, 0.5, 49};
  camera.focal_point = {0.25, 0.5, 0};
  camera.view_up = {0, 7, 0};
  const ViewBasis basis = view_basis(camera);
  EXPECT_EQ(basis.forward, glm::dvec3(0, 0, -1));
  EXPECT_EQ(basis.up, glm::dvec3(0, 1, 0));
  EXPECT_EQ(basis.right, glm::dvec3(1, 0, 0));
}

TEST(Camera, RefusesWhatHasNoDirectionOrNoUp) {
  Camera camera;
  camera.focal_point = camera.position;
  EXPECT_THROW(validate(camera), Error);
  camera = {};
  camera.view_up = {0, 0, -3};
  EXPECT_THROW(validate(camera), Error);
  camera = {};
  camera.parallel_scale = 0;
  EXPECT_THROW(validate(camera), Error);
  camera = {};
  camera.projection = ProjectionKind::perspective;
  camera.view_angle = 180;
  EXPECT_THROW(validate(camera), Error);
  camera = {};
  camera.clipping_range = ClippingRange{2, 1};
  EXPECT_THROW(validate(camera), Error);
  camera = {};
  camera.position.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(validate(camera), Error);
  EXPECT_NO_THROW(validate(Camera{}));
}

TEST(Camera, RefusesPixelsWithoutASize) {
  Camera camera;
  for (const double scale : {5e-324, 1e-310, 1e-301, 1e301, 1e308}) {
    camera.parallel_scale = scale;
    EXPECT_THROW(validate(camera), Error) << scale;
  }
  for (const double scale : {1e-300, 1.0, 1e300}) {
    camera.parallel_scale = scale;
    EXPECT_NO_THROW(validate(camera)) << scale;
  }
  camera.projection = ProjectionKind::perspective;
  for (const double angle : {5e-324, 1e-310, 1e-299}) {
    camera.view_angle = angle;
    EXPECT_THROW(validate(camera), Error) << angle;
  }
  for (const double angle : {1e-297, 30.0, 179.9999999}) {
    camera.view_angle = angle;
    EXPECT_NO_THROW(validate(camera)) << angle;
  }
  for (glm::dvec3 Camera::*place : {&Camera::position, &Camera::focal_point, &Camera::view_up}) {
    Camera far;
    (far.*place).x = 1e301;
    EXPECT_THROW(validate(far), Error);
  }
}

TEST(Camera, RefusesZoomsThatLeavePixelsNoSize) {
  const Box box{glm::dvec3(0), glm::dvec3(1)};
  for (const ProjectionKind projection : {ProjectionKind::orthographic, ProjectionKind::perspective})
    for (const double zoom : {1e308, 1e302, 1e-302, 5e-324}) {
      ViewRequest request;
      request.zoom = zoom;
      try {
        static_cast<void>(view_of_box(box, {64, 64}, request, projection, BodyAxes::none, false));
        ADD_FAILURE() << zoom;
      } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("`zoom`"), std::string::npos) << error.what();
      }
    }
}

TEST(Camera, ImageSizesOutsideOneToTheLimitAreRefused) {
  EXPECT_THROW(validate(ImageSize{0, 10}), Error);
  EXPECT_THROW(validate(ImageSize{10, 1000000000}), Error);
  EXPECT_NO_THROW(validate(ImageSize{1, max_image_side}));
}

TEST(Camera, FramedBoxFillsTheWindowAndStaysInIt) {
  for (const glm::dvec3 high : {glm::dvec3(1, 1, 1), glm::dvec3(40, 10, 1), glm::dvec3(1e-20, 3e-20, 2e-20),
                                glm::dvec3(7e6, 7e6, 100), glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0)}) {
    const Box box{glm::dvec3(0), high};
    const ImageSize size{320, 200};
    const Camera camera = frame_box(box, size);
    ASSERT_NO_THROW(validate(camera));
    const ViewBasis basis = view_basis(camera);
    double widest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) ? high.x : 0, (corner & 2) ? high.y : 0, (corner & 4) ? high.z : 0);
      const glm::dvec3 d = p - camera.position;
      EXPECT_GT(glm::dot(d, basis.forward), 0);
      const double across = std::abs(glm::dot(d, basis.right)) / (camera.parallel_scale * 1.6);
      const double upward = std::abs(glm::dot(d, basis.up)) / camera.parallel_scale;
      widest = std::max({widest, across, upward});
    }
    EXPECT_LT(widest, 1);
    EXPECT_GT(widest, glm::length(high) > 0 ? 0.8 : -1.0);
  }
}

TEST(Camera, FramedBoxInPerspectiveFillsTheWindowAndStaysInIt) {
  for (const glm::dvec3 high : {glm::dvec3(1, 1, 1), glm::dvec3(40, 10, 1), glm::dvec3(1e-20, 3e-20, 2e-20),
                                glm::dvec3(7e6, 7e6, 100), glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0)}) {
    const ImageSize size{200, 320};
    const Camera camera = frame_box({glm::dvec3(0), high}, size, ProjectionKind::perspective);
    ASSERT_NO_THROW(validate(camera));
    const ViewBasis basis = view_basis(camera);
    const double slope = std::tan(std::acos(-1.0) / 12);
    double widest = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 p((corner & 1) ? high.x : 0, (corner & 2) ? high.y : 0, (corner & 4) ? high.z : 0);
      const glm::dvec3 d = p - camera.position;
      const double depth = glm::dot(d, basis.forward);
      EXPECT_GT(depth, 0);
      widest = std::max({widest, std::abs(glm::dot(d, basis.right)) / (depth * slope * 0.625),
                         std::abs(glm::dot(d, basis.up)) / (depth * slope)});
    }
    EXPECT_LT(widest, 1);
    if (glm::length(high) > 0) {
      EXPECT_GT(widest, 0.8);
    }
  }
}

TEST(Camera, ABoxFramedForTurningStaysInTheWindowAtEveryTurn) {
  const glm::dvec3 high(13, 6, 3);
  const ImageSize size{640, 360};
  const double aspect = 640.0 / 360, slope = std::tan(std::acos(-1.0) / 12);
  for (const auto kind : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    const Camera first = frame_box({glm::dvec3(0), high}, size, kind, true);
    double widest = 0;
    for (int turn = 0; turn < 100; ++turn) {
      const Camera camera = orbit(first, turn / 100.0);
      const ViewBasis basis = view_basis(camera);
      for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) ? high.x : 0, (corner & 2) ? high.y : 0, (corner & 4) ? high.z : 0);
        const glm::dvec3 d = p - camera.position;
        const double half_height =
            kind == ProjectionKind::perspective ? glm::dot(d, basis.forward) * slope : camera.parallel_scale;
        widest = std::max({widest, std::abs(glm::dot(d, basis.right)) / (half_height * aspect),
                           std::abs(glm::dot(d, basis.up)) / half_height});
      }
    }
    EXPECT_LT(widest, 1);
    EXPECT_GT(widest, 0.9);
  }
}

TEST(Camera, AFullOrbitComesBack) {
  Camera camera;
  camera.position = {3, 2, 1};
  const Camera turned = orbit(camera, 1.0);
  EXPECT_LT(glm::length(turned.position - camera.position), 1e-14);
  const Camera half = orbit(camera, 0.5);
  EXPECT_LT(glm::length(half.position - glm::dvec3(-3, 2, -1)), 1e-14);
}

}  // namespace
}  // namespace tessera::scene
