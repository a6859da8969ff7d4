// SPDX-License-Identifier: BSD-3-Clause
#include "tessera/default_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <tuple>

#include "tessera/error.hpp"

namespace tessera {
namespace {

constexpr ImageSize square{100, 100};

Box box_of(double x, double y, double z) { return {{0, 0, 0}, {x, y, z}}; }

ViewBasis basis_of(const Box& box, const ViewRequest& request = {}, BodyAxes axes = BodyAxes::none) {
  return view_basis(view_of_box(box, square, request, ProjectionKind::orthographic, axes));
}

ViewRequest named(const char* word) {
  ViewRequest request;
  request.view = standard_view(word).value();
  return request;
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) { EXPECT_LT(glm::length(a - b), 1e-12); }

TEST(DefaultView, UprightDataHasZUpWhateverItsLongestSide) {
  for (const Box& box : {box_of(1, 1, 1), box_of(9, 2, 3), box_of(2, 9, 3), box_of(2, 3, 9), box_of(8, 9, 3)}) {
    const ViewBasis basis = basis_of(box);
    EXPECT_NEAR(basis.right.z, 0, 1e-12);
    EXPECT_NEAR(basis.forward.z, -std::sin(25 * 3.14159265358979 / 180), 1e-9);
  }
}

TEST(DefaultView, FlatThingsAreSeenFromAbove) {
  EXPECT_LT(basis_of(box_of(10, 10, 1)).forward.z, -0.8);
  EXPECT_GT(basis_of(box_of(10, 10, 3)).forward.z, -0.5);
}

TEST(DefaultView, TheWiderSideIsHorizontal) {
  EXPECT_GT(std::abs(basis_of(box_of(9, 2, 3)).right.x), 0.8);
  EXPECT_GT(std::abs(basis_of(box_of(2, 9, 3)).right.y), 0.8);
}

TEST(DefaultView, PatientsShowTheirFace) {
  // The face points to +y in RAS, to -y in LPS: the eye is on that side even if a body is deeper than wide.
  const Box body = box_of(2, 4, 9);
  EXPECT_LT(basis_of(body, {}, BodyAxes::ras).forward.y, -0.5);
  EXPECT_GT(basis_of(body, {}, BodyAxes::lps).forward.y, 0.5);
}

TEST(DefaultView, NamedViewsOfAPatientShowThatSideOfTheBody) {
  const Box body = box_of(2, 4, 9);
  const glm::dvec3 x(1, 0, 0), y(0, 1, 0);
  // Towards the patient's front and left.
  for (const auto& [axes, front, left] : {std::tuple{BodyAxes::ras, y, -x}, std::tuple{BodyAxes::lps, -y, x}}) {
    expect_near(basis_of(body, named("front"), axes).forward, -front);
    expect_near(basis_of(body, named("back"), axes).forward, front);
    expect_near(basis_of(body, named("left"), axes).forward, -left);
    expect_near(basis_of(body, named("right"), axes).forward, left);
    expect_near(basis_of(body, named("front"), axes).right, left);  // facing the patient, left is to the right
    expect_near(basis_of(body, named("+y"), axes).forward, y);
    expect_near(basis_of(body, named("-x"), axes).forward, -x);
    expect_near(basis_of(body, named("top"), axes).forward, {0, 0, -1});
  }
}

TEST(DefaultView, NamedViewsLookAlongTheirAxes) {
  const Box box = box_of(1, 2, 3);
  expect_near(basis_of(box, named("front")).forward, {0, 1, 0});
  expect_near(basis_of(box, named("front")).right, {1, 0, 0});
  expect_near(basis_of(box, named("+x")).forward, {1, 0, 0});
  expect_near(basis_of(box, named("-z")).forward, {0, 0, -1});
  expect_near(basis_of(box, named("-z")).up, {0, 1, 0});
  for (const auto& [word, axis] :
       {std::pair{"left", "+x"}, {"right", "-x"}, {"back", "-y"}, {"top", "-z"}, {"bottom", "+z"}})
    expect_near(basis_of(box, named(word)).forward, basis_of(box, named(axis)).forward);
  EXPECT_FALSE(standard_view("front "));
  EXPECT_FALSE(standard_view("x"));
}

TEST(DefaultView, AzimuthAndElevationTurnAsVtkCamerasDo) {
  // For a vtkCamera looking along +y with z up, Azimuth(90) puts the eye at +x, and Elevation(30) raises it to half of
  // its distance.
  ViewRequest request = named("front");
  request.azimuth = 90;
  expect_near(basis_of(box_of(1, 1, 1), request).forward, {-1, 0, 0});
  request.elevation = 30;
  EXPECT_NEAR(basis_of(box_of(1, 1, 1), request).forward.z, -0.5, 1e-12);
  request.elevation = 90;  // over the pole: up rotates with it
  expect_near(basis_of(box_of(1, 1, 1), request).forward, {0, 0, -1});
}

TEST(DefaultView, EveryCornerIsInThePictureAndZoomEnlarges) {
  const Box box = box_of(3, 1, 7);
  const Camera camera = view_of_box(box, {200, 100});
  const ViewBasis basis = view_basis(camera);
  double most = 0;
  for (int c = 0; c < 8; ++c) {
    const glm::dvec3 p = glm::dvec3(c & 1 ? 3 : 0, c & 2 ? 1 : 0, c & 4 ? 7 : 0) - camera.focal_point;
    most = std::max({most, std::abs(glm::dot(p, basis.up)), std::abs(glm::dot(p, basis.right)) / 2});
  }
  EXPECT_NEAR(most * 1.05, camera.parallel_scale, 1e-12);
  ViewRequest zoomed;
  zoomed.zoom = 4;
  EXPECT_DOUBLE_EQ(view_of_box(box, {200, 100}, zoomed).parallel_scale * 4, camera.parallel_scale);
}

TEST(DefaultView, ACallersCameraIsUnchangedWithoutRequests) {
  Camera camera;
  camera.position = {1, 2, 3}, camera.view_up = {0, 1, 1e-3}, camera.parallel_scale = 0.7;
  EXPECT_EQ(adjusted_view(camera, box_of(1, 1, 1), square, {}), camera);
  ViewRequest fit;
  fit.fit = true;
  const Camera fitted = adjusted_view(camera, box_of(2, 2, 2), square, fit);
  expect_near(view_basis(fitted).forward, view_basis(camera).forward);
  expect_near(fitted.focal_point, {1, 1, 1});
  EXPECT_THROW(adjusted_view(camera, box_of(1, 1, 1), square, named("front")), Error);
}

TEST(DefaultView, RefusesInvalidDirectionsAndNumbers) {
  ViewRequest request = named("front");
  request.up = glm::dvec3(0, 1, 0);
  EXPECT_THROW(view_of_box(box_of(1, 1, 1), square, request), Error);
  request.up = glm::dvec3(0);
  EXPECT_THROW(view_of_box(box_of(1, 1, 1), square, request), Error);
  request = {};
  request.zoom = 0;
  EXPECT_THROW(view_of_box(box_of(1, 1, 1), square, request), Error);
  request.zoom = 1, request.azimuth = std::nan("");
  EXPECT_THROW(view_of_box(box_of(1, 1, 1), square, request), Error);
}

}  // namespace
}  // namespace tessera
