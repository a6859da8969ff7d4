// SPDX-License-Identifier: BSD-3-Clause
#include "reference/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "reference/grid/grid_reference.hpp"
#include "reference/reference.hpp"
#include "reference/small_meshes.hpp"

/// Layers of rays known in closed form, for the reference of opacity peeling.
namespace tessera::reference::layers_test {
namespace {

constexpr scene::ImageSize size{16, 16};

scene::Camera along_z() {
  scene::Camera camera;
  camera.position = {0, 0, 5}, camera.focal_point = {0, 0, 0};
  camera.parallel_scale = 1.2;
  return camera;
}

std::unique_ptr<scene::MemorySource> grid_of(const Field& field) {
  scene::Grid grid;
  grid.geometry.points = {5, 5, 5};
  grid.geometry.origin = glm::dvec3(-1), grid.geometry.spacing = glm::dvec3(0.5);
  std::vector<float> values;
  for (int k = 0; k < 5; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = 0; i < 5; ++i) values.push_back(static_cast<float>(field(glm::dvec3(i, j, k) * 0.5 - 1.0)));
  return scene::MemorySource::of(grid, std::move(values));
}

double constant(const glm::dvec3&) { return 0.5; }
double height(const glm::dvec3& p) { return p.z; }

/// The box [-1, 1]^3 as a mesh and as a grid, at places that meet no edge.
struct Both {
  Both(const Field& field, const scene::TransferFunction& function, const Surfaces& surfaces = {})
      : mesh(box_of_tets(3, glm::dvec3(-1), glm::dvec3(1), field)),
        source(grid_of(field)),
        by_mesh(mesh, along_z(), size, function, scene::Emission::absorption, surfaces),
        by_grid(*source, along_z(), size, function, scene::Emission::absorption, {}, {}, surfaces) {}

  [[nodiscard]] std::vector<std::vector<Pixel>> layers(const Peel& peel) const {
    return {by_mesh.layers(8.13, 7.21, peel), by_grid.layers(8.13, 7.21, peel)};
  }

  scene::TetMesh mesh;
  std::unique_ptr<scene::MemorySource> source;
  Reference by_mesh;
  GridReference by_grid;
};

TEST(ReferenceLayers, OfHomogeneousMatterAreOfOneThickness) {
  const double extinction = 3.5;
  const Both both(constant, scene::TransferFunction({{0.5, {0.8, 0.4, 0.2}, extinction}}));
  for (const double threshold : {0.1, 0.5, 0.95}) {
    const double thickness = -std::log1p(-threshold) / extinction;
    for (const auto& layers : both.layers({threshold, 5})) {
      ASSERT_EQ(layers.size(), 5u);
      for (int n = 0; n < 5; ++n) {
        const double front = n * thickness, back = n < 4 ? std::min(2.0, front + thickness) : 2;
        const double opacity = front < 2 ? -std::expm1(-extinction * (back - front)) : 0;
        const Pixel& layer = layers[static_cast<std::size_t>(n)];
        EXPECT_NEAR(layer.a, opacity, 1e-12) << threshold << ' ' << n;
        EXPECT_NEAR(layer.r, 0.8 * opacity, 1e-12);
        EXPECT_NEAR(layer.b, 0.2 * opacity, 1e-12);
        const bool shows = front < 2;
        EXPECT_EQ(std::isfinite(layer.z), shows);
        EXPECT_NEAR(shows ? layer.z : 4 + front, 4 + front, 1e-9);
      }
    }
  }
}

/// The extinction is k (1 + z). From the front at z = 1, the optical depth of a distance d is k (2 d - d^2 / 2), a
/// parabola.
TEST(ReferenceLayers, OfARampEndAtTheClosedFormsDepth) {
  const double steepness = 2;
  const Both both(height, scene::TransferFunction({{-1, {1, 1, 1}, 0}, {1, {1, 1, 1}, 2 * steepness}}));
  const double threshold = 0.6, limit = -std::log1p(-threshold);
  for (const auto& layers : both.layers({threshold, 64})) {
    for (std::size_t n = 0; n < 4; ++n) {
      // From z = 1 down: the optical depth to z is steepness (4 - (1 + z)^2) / 2.
      const double z = std::sqrt(4 - 2 * static_cast<double>(n) * limit / steepness) - 1;
      EXPECT_NEAR(layers[n].z, 5 - z, 1e-9) << n;
      EXPECT_NEAR(layers[n].a, threshold, 1e-12) << n;
    }
    EXPECT_NEAR(layers[4].a, -std::expm1(-(4 - 4 * limit)), 1e-12);
    EXPECT_EQ(layers[5].a, 0);
  }
}

TEST(ReferenceLayers, CompositedAreThePixel) {
  const scene::TransferFunction function(
      {{-1, {1, 0, 0}, 0}, {-0.2, {0, 1, 0}, 3}, {-0.2, {0, 0.5, 1}, 0.1}, {0.4, {1, 1, 0}, 9}, {1, {0, 1, 1}, 2}});
  const Both both([](const glm::dvec3& p) { return std::sin(2 * p.z + p.x); }, function);
  for (const double threshold : {0.1, 0.7, 0.99})
    for (const int count : {1, 3, 64}) {
      const Pixel truths[] = {both.by_mesh.pixel(8.13, 7.21), both.by_grid.pixel(8.13, 7.21)};
      const auto layers = both.layers({threshold, count});
      for (std::size_t which = 0; which < 2; ++which) {
        Pixel sum;
        double through = 1;
        for (const Pixel& layer : layers[which]) {
          sum.r += through * layer.r, sum.g += through * layer.g, sum.b += through * layer.b;
          through *= 1 - layer.a;
        }
        const Pixel& truth = truths[which];
        EXPECT_NEAR(sum.r, truth.r, 1e-12) << threshold << ' ' << count;
        EXPECT_NEAR(sum.g, truth.g, 1e-12);
        EXPECT_NEAR(sum.b, truth.b, 1e-12);
        EXPECT_NEAR(1 - through, truth.a, 1e-12);
      }
    }
}

TEST(ReferenceLayers, ASurfaceIsTheEndOfTheLayerItFills) {
  Surfaces surfaces;
  for (const double value : {-0.55, -0.35, 0.15, 0.65}) surfaces.iso.push_back({value, glm::dvec3(1, 0.5, 0), 0.5});
  surfaces.iso[1].opacity = 1;
  surfaces.light = {1, 0, 0, 1};
  const Both both(height, scene::TransferFunction({{0, {1, 1, 1}, 0}}), surfaces);
  for (const auto& layers : both.layers({0.75, 4})) {
    // From the eye on, the surfaces have the opacities 0.5 and 0.5 (together equal to the threshold), 1, and 0.5.
    const double opacities[] = {0.75, 1, 0.5, 0}, places[] = {0.65, -0.35, -0.55, 0};
    for (std::size_t n = 0; n < 4; ++n) {
      EXPECT_NEAR(layers[n].a, opacities[n], 1e-12) << n;
      EXPECT_NEAR(layers[n].r, opacities[n], 1e-12) << n;
      if (n < 3) {
        EXPECT_NEAR(layers[n].z, 5 - places[n], 1e-9) << n;
      }
    }
  }
}

}  // namespace
}  // namespace tessera::reference::layers_test
