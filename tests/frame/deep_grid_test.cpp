// SPDX-License-Identifier: BSD-3-Clause
// The promise of deep images, for volumes: flattened they equal the image, and with an opaque plane inserted at any
// depth they are within the accuracy of a rendering that ends there. The expected values are reference/'s.
#include "frame/grid/deep_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "reference/grid/grid_reference.hpp"
#include "scene/error.hpp"
#include "support/deep_pixels.hpp"
#include "support/some_cases.hpp"

namespace tessera::deep_grid_test {
namespace {

constexpr scene::ImageSize size{30, 26};

std::unique_ptr<scene::MemorySource> noise(scene::Association association, bool rectilinear = false) {
  scene::Grid grid;
  grid.geometry.association = association;
  grid.geometry.points = {19, 8, 9};  // two blocks along x
  grid.geometry.spacing = {0.5, 1, 1.3};
  grid.geometry.origin = {-4, -3, -5};
  if (rectilinear) grid.geometry.coordinates[1] = {0, 0.5, 1, 2, 2.1, 4, 5, 6};
  std::mt19937 random(7);
  std::vector<float> values(static_cast<std::size_t>(grid.geometry.all_samples().count()));
  for (float& v : values) v = std::uniform_real_distribution<float>(0, 1)(random);
  values[100] = NAN;
  return scene::MemorySource::of(grid, std::move(values));
}

std::vector<scene::Camera> views(const scene::SampleSource& source) {
  scene::Camera outside = scene::frame_box(scene::bounds(source.geometry()), size), inside = outside;
  inside.projection = scene::ProjectionKind::perspective;
  inside.view_angle = 100;
  inside.position = {0.3, -0.2, 0.1}, inside.focal_point = {2, 1, 3};
  return {outside, inside};
}

const scene::TransferFunction smooth({{0, {0.1, 0.2, 0.9}, 0}, {0.5, {0.9, 0.8, 0.1}, 0.7}, {1, {1, 0.2, 0.1}, 0.2}});
const scene::TransferFunction sharp(
    {{0, {0, 0, 1}, 0}, {0.55, {0, 0, 1}, 0}, {0.55, {1, 0.3, 0}, 2}, {0.8, {1, 0.9, 0}, 5}, {1, {0, 0.9, 1}, 60}});

scene::DeepImage deep(const scene::SampleSource& source, const scene::Camera& camera, const scene::TransferFunction& f,
                      double accuracy, scene::Emission emission = scene::Emission::absorption) {
  frame::DeepSettings settings;
  settings.frame.deep_accuracy = accuracy;
  settings.emission = emission;
  settings.threads = 2;
  return frame::deep_image(source, camera, size, f, settings, 0, size.height);
}

/// Largest difference between a composited pixel and the exact one, for rays that end at `z` (infinite: never).
double error_at(const scene::DeepImage& image, const scene::SampleSource& source, scene::Camera camera,
                const scene::TransferFunction& function, double z,
                scene::Emission emission = scene::Emission::absorption) {
  const std::array<double, 3> plane{0.2, 1, 0.6};
  const bool ends = std::isfinite(z);
  if (ends) camera.clipping_range = scene::ClippingRange{0, z};
  const reference::GridReference truth(source, camera, size, function, emission);
  double worst = 0;
  for (int y = 1; y < size.height; y += 3)
    for (int x = 1; x < size.width; x += 3) {
      const reference::Pixel p = truth.pixel(x + 0.5, y + 0.5);
      const double through = ends ? 1 - p.a : 0;
      const std::array<double, 4> wanted{p.r + through * plane[0], p.g + through * plane[1], p.b + through * plane[2],
                                         ends ? 1 : p.a};
      const auto pixel = image.pixel(static_cast<std::size_t>(y * size.width + x));
      const auto got = tests::composited(pixel, z, plane);
      for (std::size_t c = 0; c < 4; ++c) worst = std::max(worst, std::abs(got[c] - wanted[c]));
    }
  return worst;
}

TEST(DeepGrid, FlattenedItIsThePicture) {
  test::SomeCases some(3);
  for (const auto association : {scene::Association::point, scene::Association::cell})
    for (const bool rectilinear : {false, true}) {
      const auto source = noise(association, rectilinear);
      for (const scene::Camera& camera : views(*source))
        for (const auto& function : {smooth, sharp}) {
          if (!some.next()) continue;
          EXPECT_LT(error_at(deep(*source, camera, function, 1e-3), *source, camera, function, HUGE_VAL), 1e-5);
          constexpr auto independent = scene::Emission::independent;
          EXPECT_LT(error_at(deep(*source, camera, function, 1e-3, independent), *source, camera, function, HUGE_VAL,
                             independent),
                    1e-4);  // the light along the whole path is up to 10 per pixel
        }
    }
}

TEST(DeepGrid, CutAnywhereItIsWithinItsAccuracy) {
  const auto source = noise(scene::Association::point);
  for (const scene::Camera& camera : views(*source))
    for (const auto& function : {smooth, sharp})
      for (const double accuracy : {1e-2, 1e-3, 1e-4}) {
        const scene::DeepImage image = deep(*source, camera, function, accuracy);
        const double middle = glm::length(camera.position - glm::dvec3(0, 0.5, 0.2));
        for (const double off : {-3.0, -1.1, 0.0, 0.7, 2.5})
          EXPECT_LT(error_at(image, *source, camera, function, std::max(0.1, middle + off)), accuracy) << off;
      }
}

TEST(DeepGrid, SurfacesAreSamplesWithoutLength) {
  Surfaces iso;
  iso.iso = {{0.4, glm::dvec3(1, 0.3, 0), 0.35}, {0.7, {}, 1}};
  for (const bool rectilinear : {false, true}) {
    const auto source = noise(scene::Association::point, rectilinear);
    const volume::GridSurfaces surfaces(iso, smooth, volume::CellRanges(*source));
    for (const scene::Camera& camera : views(*source)) {
      frame::DeepSettings settings;
      settings.surfaces_of_grid = &surfaces;
      settings.threads = 2;
      const scene::DeepImage image = frame::deep_image(*source, camera, size, smooth, settings, 0, size.height);
      const reference::GridReference truth(*source, camera, size, smooth, scene::Emission::absorption, {}, {}, iso);
      std::size_t points = 0;
      for (int y = 0; y < size.height; y += 2)
        for (int x = 0; x < size.width; x += 2) {
          const auto pixel = image.pixel(static_cast<std::size_t>(y * size.width + x));
          for (const auto& s : pixel) points += s.z == s.z_back ? 1 : 0;
          const reference::Pixel p = truth.pixel(x + 0.5, y + 0.5);
          const std::array<double, 4> wanted{p.r, p.g, p.b, p.a};
          const auto got = tests::composited(pixel);
          for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(got[c], wanted[c], 1e-5) << x << ' ' << y;
        }
      EXPECT_GT(points, 100u);
    }
  }
}

TEST(DeepGrid, SamplesAreTidyAndFewerWhereLessIsAsked) {
  const auto source = noise(scene::Association::point);
  const scene::Camera camera = views(*source)[0];
  const scene::DeepImage fine = deep(*source, camera, smooth, 1e-4), coarse = deep(*source, camera, smooth, 1e-2);
  EXPECT_LT(2 * coarse.samples.size(), fine.samples.size());
  for (std::size_t p = 0; p + 1 < fine.begin.size(); ++p) {
    float last = -HUGE_VALF;
    for (const scene::DeepImageSample& s : fine.pixel(p)) {
      EXPECT_LE(last, s.z);
      EXPECT_LE(s.z, s.z_back);
      last = s.z_back;
    }
  }
}

}  // namespace
}  // namespace tessera::deep_grid_test
