// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"
#include "scene/error.hpp"

namespace tessera::reference::reference_closed_form_test {
namespace {

using scene::Knot;
using scene::ProjectionKind;
using scene::TransferFunction;

constexpr double rounding = 1e-13;

/// Allowed deviation of lengths from the true geometry, world units. Perspective: rounding, positions of order one and
/// up to 40 segments; wide angles stretch a unit of depth by up to five. Orthographic: by definition vertices are
/// rounded by up to 2^-33 pixel, here at most 2e-11 units, which oblique faces magnify: up to tenfold on a box, a
/// hundredfold at the silhouette of a ball.
double tolerance(const scene::Camera& camera, double slant) {
  return camera.projection == ProjectionKind::perspective ? 1e-12 : 2e-11 * slant;
}

double any_field(const glm::dvec3& p) { return p.x + 2 * p.y - 0.5 * p.z; }

/// A fan of tets from the centre to a sphere of triangles: an octahedron, refined.
scene::TetMesh ball(int refinements) {
  scene::TetMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const std::uint32_t x : {1u, 2u})
    for (const std::uint32_t y : {3u, 4u})
      for (const std::uint32_t z : {5u, 6u}) triangles.push_back({x, y, z});
  for (int level = 0; level < refinements; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [found, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
      return found->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t :
           {std::array{a, ab, ca}, std::array{ab, b, bc}, std::array{ca, bc, c}, std::array{ab, bc, ca}})
        finer.push_back(t);
    }
    triangles = finer;
  }
  for (const auto& [a, b, c] : triangles) mesh.tets.push_back({0, a, b, c});
  mesh.scalars.assign(mesh.positions.size(), 1.0);
  return mesh;
}

/// Length of a ray in the ball's convex hull, from its outer planes.
double chord(const scene::TetMesh& ball, const WorldRay& ray) {
  double low = -1e300, high = 1e300;
  for (const scene::Tet& t : ball.tets) {
    const glm::dvec3 &a = ball.positions[t[1]], &b = ball.positions[t[2]], &c = ball.positions[t[3]];
    glm::dvec3 normal = glm::cross(b - a, c - a);
    if (glm::dot(normal, a) < 0) normal = -normal;
    const double slope = glm::dot(normal, ray.direction), room = glm::dot(normal, a - ray.origin);
    if (slope > 0) high = std::min(high, room / slope);
    if (slope < 0) low = std::max(low, room / slope);
  }
  return std::max(0.0, high - low) * glm::length(ray.direction);
}

TEST(Reference, HomogeneousBallObeysBeerAndLambertAlongItsChord) {
  const scene::TetMesh mesh = ball(3);
  const TransferFunction transfer_function({{0, {1, 0.5, 0.25}, 0.8}});
  const scene::ImageSize size{31, 31};
  for (const ProjectionKind projection : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    const scene::Camera camera =
        looking({1, 2, 4}, {0, 0, 0}, projection, projection == ProjectionKind::orthographic ? 1.1 : 30);
    const Reference reference(mesh, camera, size, transfer_function);
    const std::vector<Pixel> image = reference.image();
    int hits = 0;
    for (const PixelIndex& p : all_pixels(size)) {
      const Pixel& found = image[static_cast<std::size_t>(p.y * 31 + p.x)];
      const double length = chord(mesh, world_ray(camera, size, p.x + 0.5, p.y + 0.5));
      EXPECT_NEAR(found.length, length, tolerance(camera, 100));
      EXPECT_NEAR(found.a, -std::expm1(-0.8 * length), tolerance(camera, 100));
      EXPECT_NEAR(found.g, 0.5 * found.a, rounding);
      hits += found.segments > 0;
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(Reference, FinerBallsConvergeToTheSphere) {
  const TransferFunction transfer_function({{0, {1, 1, 1}, 0.8}});
  const scene::Camera camera = looking({1, 2, 4}, {0, 0, 0}, ProjectionKind::orthographic, 1.0);
  double error_before = 1;
  for (const int refinements : {1, 2, 3, 4, 5}) {
    const scene::TetMesh mesh = ball(refinements);
    const Reference reference(mesh, camera, {40, 40}, transfer_function);
    double error = 0;
    for (const double x : {20.3, 23.1, 30.7}) {  // at distances 0.025, 0.16 and 0.54 from the axis
      const double d = std::hypot(x - 20, 20.4 - 20) / 20;
      error = std::max(error, std::abs(reference.pixel(x, 20.4).a + std::expm1(-0.8 * 2 * std::sqrt(1 - d * d))));
    }
    if (refinements > 1) {
      EXPECT_LT(error, error_before / 2.5);  // second order: about a quarter
    }
    error_before = error;
  }
  EXPECT_LT(error_before, 1e-3);
}

/// Every kind of view of a box: the correct length of each ray in it follows from clipping it to the slabs.
struct BoxView {
  const char* name;
  scene::Camera camera;
};

std::vector<BoxView> box_views() {
  const auto orthographic = ProjectionKind::orthographic, perspective = ProjectionKind::perspective;
  std::vector<BoxView> views{
      {"orthographic", looking({3, 4, 5}, {0.1, 0, 0}, orthographic, 1.9)},
      {"orthographic, position inside", looking({0.1, 0.2, 0.3}, {1, 3, 2}, orthographic, 1.9)},
      {"perspective", looking({3, 4, 5}, {0.1, 0, 0}, perspective, 25)},
      {"perspective, wide", looking({1.04, 0.3, 0.2}, {0, 0.1, 0}, perspective, 150)},
      {"eye inside a cell", looking({0.13, 0.21, -0.37}, {2, 1, 0.3}, perspective, 110)},
      {"eye on a vertex", looking({0, 0, 0}, {0.3, 0.2, 1}, perspective, 100)},
      {"eye on an edge", looking({0.25, 0.25, 0.25}, {0.9, -0.2, 0.4}, perspective, 100)},
      {"eye in a face", looking({0.25, 0.125, 0}, {0.9, -0.2, 0.4}, perspective, 100)},
      {"eye on the surface", looking({0.3, -0.1, 1}, {0.9, -0.2, -0.4}, perspective, 100)},
  };
  for (const ProjectionKind projection : {orthographic, perspective}) {
    BoxView cut{"near and far planes",
                looking({1.5, 2, 2.5}, {0, 0, 0}, projection, projection == orthographic ? 1.9 : 60)};
    cut.camera.clipping_range = scene::ClippingRange{3.1, 3.9};
    views.push_back(cut);
  }
  return views;
}

TEST(Reference, EveryRayThroughABoxHasItsLengthInEveryView) {
  const glm::dvec3 low(-1, -1, -1), high(1, 1, 1);
  const scene::ImageSize size{33, 21};
  const TransferFunction transfer_function({{0, {0.5, 0.5, 0.5}, 0.7}});
  for (const double jitter : {0.0, 0.15}) {
    const scene::TetMesh mesh = box_of_tets(4, low, high, any_field, jitter);
    for (const BoxView& view : box_views()) {
      const Reference reference(mesh, view.camera, size, transfer_function);
      const std::vector<Pixel> image = reference.image();
      int hits = 0;
      for (const PixelIndex& p : all_pixels(size)) {
        const WorldRay ray = world_ray(view.camera, size, p.x + 0.5, p.y + 0.5);
        DepthRange range = depths_in_box(ray, low, high);
        if (view.camera.clipping_range) {
          range.low = std::max(range.low, view.camera.clipping_range->near_distance);
          range.high = std::min(range.high, view.camera.clipping_range->far_distance);
        }
        const double length = range.size() * glm::length(ray.direction);
        const Pixel& found = image[static_cast<std::size_t>(p.y * size.width + p.x)];
        const double error = tolerance(view.camera, 10);
        ASSERT_NEAR(found.length, length, error) << view.name << " pixel " << p.x << ' ' << p.y << " jitter " << jitter;
        ASSERT_NEAR(found.a, -std::expm1(-0.7 * length), error) << view.name;
        if (length > 1e-9) {
          ASSERT_NEAR(found.z, range.low, error) << view.name;
        }
        hits += length > 0;
      }
      EXPECT_GT(hits, 100) << view.name;
    }
  }
}

TEST(Reference, LinearRampAlongTheViewIsAnalytic) {
  // s = depth from 0 to 1 through the box, kappa = 6 s, c = s: with a = 3,
  // I = int 6 t^2 exp(-3 t^2) dt = -exp(-3) + sqrt(pi / 3) / 2 erf(sqrt 3).
  const scene::TetMesh mesh = box_of_tets(3, {-1, -1, 0}, {1, 1, 1}, [](const glm::dvec3& p) { return 1 - p.z; });
  const TransferFunction transfer_function({{0, {0, 1, 0.5}, 0}, {1, {1, 1, 0.5}, 6}});
  const Reference reference(mesh, looking({0, 0, 4}, {0, 0, 0}, ProjectionKind::orthographic, 1), {8, 8},
                            transfer_function);
  const double truth = -std::exp(-3.0) + std::sqrt(std::acos(-1.0) / 3) / 2 * std::erf(std::sqrt(3.0));
  for (const Pixel& p : reference.image()) {
    EXPECT_NEAR(p.r, truth, rounding);
    EXPECT_NEAR(p.a, -std::expm1(-3.0), rounding);
    EXPECT_NEAR(p.b, 0.5 * p.a, rounding);
    EXPECT_EQ(p.z, 3);
  }
}

TEST(Reference, AStepBecomesASurfaceInsideTheCells) {
  const scene::TetMesh mesh = box_of_tets(2, {-1, -1, 0}, {1, 1, 1}, [](const glm::dvec3& p) { return 1 - p.z; });
  const TransferFunction transfer_function({{0, {1, 1, 1}, 0}, {0.3, {1, 1, 1}, 0}, {0.3, {1, 1, 1}, 5}});
  const Reference reference(mesh, looking({0, 0, 4}, {0, 0, 0}, ProjectionKind::orthographic, 1), {8, 8},
                            transfer_function);
  for (const Pixel& p : reference.image()) {
    EXPECT_NEAR(p.a, -std::expm1(-0.7 * 5), rounding);
    EXPECT_NEAR(p.z, 3.3, rounding);
  }
}

TEST(Reference, CellDataIsConstantInEachCellAndTwoMaterialsAddUp) {
  const Field material = [](const glm::dvec3& p) { return p.z > 0.5 ? 1.0 : 2.0; };
  const scene::TetMesh mesh = with_cell_data(box_of_tets(4, {-1, -1, 0}, {1, 1, 1}, material), material);
  const TransferFunction transfer_function(
      {{1, {1, 0, 0}, 2}, {2, {1, 0, 0}, 2}, {2, {0, 0, 1}, 7}, {3, {0, 0, 1}, 7}});  // 2 is exactly on the step
  const Reference reference(mesh, looking({0.01, 0.02, 4}, {0.01, 0.02, 0}, ProjectionKind::orthographic, 0.9), {9, 9},
                            transfer_function);
  for (const Pixel& p : reference.image()) {
    EXPECT_NEAR(p.r, -std::expm1(-1.0), rounding);
    EXPECT_NEAR(p.b, std::exp(-1.0) * -std::expm1(-3.5), rounding);
  }
}

TEST(Reference, IndependentEmissionNeedsNoExtinction) {
  const scene::TetMesh mesh = box_of_tets(3, {-1, -1, 0}, {1, 1, 1}, any_field, 0.1);
  const Reference clear(mesh, looking({0, 0, 4}, {0, 0, 0}, ProjectionKind::orthographic, 0.9), {8, 8},
                        TransferFunction({{0, {0.25, 0.5, 1}, 0}}), scene::Emission::independent);
  for (const Pixel& p : clear.image()) {
    EXPECT_NEAR(p.g, 0.5, rounding);
    EXPECT_EQ(p.a, 0);
    EXPECT_TRUE(std::isinf(p.z));
  }
}

TEST(Reference, SplittingEachTetInFourLeavesTheImage) {
  const scene::TetMesh mesh = box_of_tets(
      3, {-1, -1, -1}, {1, 1, 1}, [](const glm::dvec3& p) { return std::sin(3 * p.x) * std::cos(2 * p.y + p.z); },
      0.15);
  std::vector<Knot> knots;
  for (int i = 0; i < 30; ++i) knots.push_back({-1 + i / 15.0, {i % 3 / 2.0, i % 4 / 3.0, i % 5 / 4.0}, i % 7 * 0.5});
  const TransferFunction transfer_function(knots);
  const scene::TetMesh split = split_in_four(mesh);
  for (const auto projection : {ProjectionKind::orthographic, ProjectionKind::perspective}) {
    const scene::Camera camera =
        looking({2, 1, 3}, {0, 0, 0}, projection, projection == ProjectionKind::orthographic ? 1.5 : 40);
    const std::vector<Pixel> coarse = Reference(mesh, camera, {24, 24}, transfer_function).image();
    const std::vector<Pixel> fine = Reference(split, camera, {24, 24}, transfer_function).image();
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      EXPECT_NEAR(coarse[i].r, fine[i].r, tolerance(camera, 10));
      EXPECT_NEAR(coarse[i].a, fine[i].a, tolerance(camera, 10));
      EXPECT_GE(fine[i].segments, coarse[i].segments);
    }
  }
}

TEST(Reference, ScenesOfAnySizeGiveTheSameColours) {
  const auto colours = [](double unit) {
    const scene::TetMesh mesh = box_of_tets(
        3, glm::dvec3(-unit), glm::dvec3(unit), [&](const glm::dvec3& p) { return p.x / unit; }, 0.15);
    const TransferFunction transfer_function({{-1, {0, 1, 0}, 0}, {1, {1, 0, 1}, 2 / unit}});
    return Reference(mesh, looking(glm::dvec3(2, 1, 3) * unit, {0, 0, 0}, ProjectionKind::perspective, 40), {16, 16},
                     transfer_function)
        .image();
  };
  const std::vector<Pixel> truth = colours(1);
  for (const double unit : {1e-20, 1e20}) {
    const std::vector<Pixel> found = colours(unit);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      EXPECT_NEAR(found[i].r, truth[i].r, 1e-12);
      EXPECT_NEAR(found[i].a, truth[i].a, 1e-12);
      EXPECT_EQ(found[i].segments, truth[i].segments);
    }
  }
}

TEST(Reference, OnePixelAndTheWholeImageAgreeForAnyThreads) {
  const scene::TetMesh mesh = box_of_tets(4, {-1, -1, -1}, {1, 1, 1}, any_field, 0.15);
  const Reference reference(mesh, looking({2, 1, 3}, {0, 0, 0}, ProjectionKind::perspective, 40), {40, 23},
                            TransferFunction({{-1, {0, 1, 0}, 0}, {1, {1, 0, 1}, 2}}));
  const std::vector<Pixel> one = reference.image(1), two = reference.image(2);
  std::vector<PixelIndex> backwards = all_pixels({40, 23});
  std::reverse(backwards.begin(), backwards.end());
  const std::vector<Pixel> reversed = reference.pixels(backwards);
  for (const PixelIndex& p : backwards) {
    const auto i = static_cast<std::size_t>(p.y * 40 + p.x);
    const Pixel alone = reference.pixel(p.x + 0.5, p.y + 0.5);
    for (const Pixel& other : {one[i], two[i], reversed[reversed.size() - 1 - i]}) {
      EXPECT_EQ(alone.r, other.r);
      EXPECT_EQ(alone.a, other.a);
      EXPECT_EQ(alone.z, other.z);
      EXPECT_EQ(alone.segments, other.segments);
    }
  }
}

TEST(Reference, AnEmptyMeshGivesAnEmptyImage) {
  const scene::TetMesh mesh;
  const Reference reference(mesh, scene::Camera{}, {3, 2}, TransferFunction({{0, {1, 1, 1}, 1}}));
  for (const Pixel& p : reference.image()) {
    EXPECT_EQ(p.a, 0);
    EXPECT_EQ(p.segments, 0u);
    EXPECT_TRUE(std::isinf(p.z));
  }
}

TEST(Reference, RefusesInvalidViews) {
  const scene::TetMesh mesh;
  scene::Camera camera;
  camera.focal_point = camera.position;
  EXPECT_THROW(Reference(mesh, camera, {3, 2}, TransferFunction({{0, {1, 1, 1}, 1}})), scene::Error);
  EXPECT_THROW(Reference(mesh, {}, {0, 2}, TransferFunction({{0, {1, 1, 1}, 1}})), scene::Error);
  EXPECT_THROW(Reference(mesh, {}, {3, 2}, TransferFunction()), scene::Error);
}

}  // namespace
}  // namespace tessera::reference::reference_closed_form_test
