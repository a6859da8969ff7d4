// Blank samples, constant volumes, and plateaus of the field at the value of a step of the transfer function: what
// lanes of floats round must not move a sample, or a voxel, to the wrong side. Every pixel against the reference in
// double precision.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "reference/grid_reference.hpp"
#include "reference/judge.hpp"
#include "scene/camera.hpp"
#include "scene/sample_source.hpp"
#include "volume/render.hpp"

namespace tessera {
namespace {

constexpr double blank = std::numeric_limits<double>::quiet_NaN();

scene::Grid grid_of(std::int64_t n, scene::Association association = scene::Association::point) {
  scene::Grid grid;
  grid.geometry.points = {n, n, n};
  grid.geometry.association = association;
  grid.geometry.spacing = glm::dvec3(2.0 / static_cast<double>(n - 1));
  grid.geometry.origin = glm::dvec3(-1);
  return grid;
}

/// value(x, y, z) over [-1, 1]^3.
template <class T, class Value>
std::unique_ptr<scene::MemorySource> volume_of(const scene::Grid& grid, const Value& value) {
  const scene::GridIndex n = grid.geometry.samples();
  std::vector<T> values;
  const auto place = [](std::int64_t i, std::int64_t count) {
    return count > 1 ? 2.0 * static_cast<double>(i) / static_cast<double>(count - 1) - 1 : 0.0;
  };
  for (std::int64_t k = 0; k < n[2]; ++k)
    for (std::int64_t j = 0; j < n[1]; ++j)
      for (std::int64_t i = 0; i < n[0]; ++i)
        values.push_back(static_cast<T>(value(place(i, n[0]), place(j, n[1]), place(k, n[2]))));
  return scene::MemorySource::of(grid, std::move(values));
}

std::vector<scene::Camera> views_of(const scene::SampleSource& source, scene::ImageSize size) {
  const scene::Camera outside = scene::frame_box(scene::bounds(source.geometry()), size);
  scene::Camera along = outside, inside = outside;
  along.position = {0.01, 0.02, 5}, along.focal_point = {0.01, 0.02, 0}, along.view_up = {0, 1, 0};
  inside.projection = scene::ProjectionKind::perspective;
  inside.view_angle = 100;
  inside.position = {0.3, -0.2, 0.1}, inside.focal_point = {-0.6, 0.5, -0.4};
  return {outside, along, inside};
}

void expect_right(const scene::SampleSource& source, const std::vector<scene::Knot>& knots, scene::ImageSize size,
                  const std::string& what) {
  const scene::TransferFunction function(knots);
  int number = 0;
  for (const scene::Camera& camera : views_of(source, size)) {
    const reference::GridReference truth(source, camera, size, function, scene::Emission::absorption);
    for (const volume::Method method : {volume::Method::exact, volume::Method::automatic}) {
      volume::RenderSettings settings;
      settings.method = method;
      settings.threads = 2;
      const double bound = method == volume::Method::exact ? 1e-5 : 1e-4;
      const scene::Image image = volume::Renderer(source, settings).render(camera, size, function);
      const auto judgement = reference::judge(image, truth, bound, {}, 2);
      EXPECT_LE(judgement.max_error_not_excused, bound)
          << what << ", view " << number << ", bound " << bound << ", worst at " << judgement.worst_x << ' '
          << judgement.worst_y;
    }
    ++number;
  }
}

/// Two slabs at once are a line only where both have a field; a maximum that drops NaN took whole packets for it.
TEST(PlateauGrid, BlankSamplesHideNothingButTheirOwnVoxels) {
  const auto ball = volume_of<float>(grid_of(48), [](double x, double y, double z) {
    const double r = std::sqrt(x * x + y * y + z * z);
    return r <= 0.9 ? r : blank;
  });
  const std::vector<scene::Knot> few{{0, {0, 0, 1}, 0}, {0.3, {0, 0, 0}, 0}, {1, {1, 1, 1}, 0.5}};
  expect_right(*ball, few, {120, 120}, "ball");
  std::vector<scene::Knot> dense = few;
  for (scene::Knot& knot : dense) knot.extinction *= 40;
  expect_right(*ball, dense, {60, 60}, "dense ball");
}

/// The bits of a pixel do not depend on which others are cast with it.
TEST(PlateauGrid, RegionsHaveTheBitsOfTheWhole) {
  std::mt19937 random(5);
  const auto noise = volume_of<float>(grid_of(40), [&](double x, double y, double z) {
    return random() % 97 == 0 ? blank : 0.5 + 0.4 * std::sin(5 * x + 3 * y) * std::cos(4 * z) + 1e-3 * (random() % 100);
  });
  const scene::TransferFunction function(
      {{0.1, {0, 0, 1}, 0}, {0.4, {0, 1, 0}, 3}, {0.6, {1, 0, 0}, 0.5}, {1, {1, 1, 1}, 9}});
  const scene::ImageSize size{96, 80};
  for (const scene::Camera& camera : views_of(*noise, size)) {
    volume::RenderSettings settings;
    settings.threads = 2;
    volume::Renderer renderer(*noise, settings);
    const scene::Image whole = renderer.render(camera, size, function);
    for (int i = 0; i < 6; ++i) {
      const int x = static_cast<int>(random() % 22) * 4, y = static_cast<int>(random() % 18) * 4;
      const volume::PixelRegion region{x, y, std::min(x + 4 + 4 * static_cast<int>(random() % 9), size.width),
                                       std::min(y + 4 + 4 * static_cast<int>(random() % 9), size.height)};
      const scene::Image part = renderer.render(camera, size, function, nullptr, region);
      for (int v = region.y0; v < region.y1; ++v)
        for (int u = region.x0; u < region.x1; ++u)
          for (std::size_t c = 0; c < 4; ++c)
            ASSERT_EQ(part.rgba[4 * part.index(u, v) + c], whole.rgba[4 * whole.index(u, v) + c]) << u << ' ' << v;
    }
  }
}

/// One value has no range to take a unit from: knots on both sides of it were one.
TEST(PlateauGrid, ConstantVolumesAreTheFunctionAtTheirValue) {
  const scene::ImageSize size{24, 20};
  for (const auto association : {scene::Association::point, scene::Association::cell})
    for (const std::int64_t n : {2, 9}) {
      const scene::Grid grid = grid_of(n, association);
      const auto seven = volume_of<std::uint8_t>(grid, [](double, double, double) { return 7; });
      expect_right(*seven, {{6.5, {1, 0, 0}, 0}, {7.5, {0, 0, 1}, 0.3}}, size, "7 between near knots");
      const auto far = volume_of<float>(grid, [](double, double, double) { return 7.25; });
      expect_right(*far, {{-1e3, {1, 0, 0}, 0}, {1e3, {0, 0, 1}, 0.3}}, size, "7.25 between far knots");
      const auto third = volume_of<double>(grid, [](double, double, double) { return -1.0 / 3; });
      for (const double step : {-1.0 / 3, std::nextafter(-1.0 / 3, 1.0), std::nextafter(-1.0 / 3, -1.0)})
        expect_right(*third, {{step, {1, 0, 0}, 0.2}, {step, {0, 0, 1}, 0.9}}, size, "a step beside -1/3");
      const auto zero = volume_of<float>(grid, [](double, double, double) { return 0.0; });
      expect_right(*zero, {{0, {1, 0, 0}, 0.2}, {0, {0, 0, 1}, 0.9}, {1e-30, {0, 1, 0}, 0}}, size, "a step at 0");
    }
}

/// Samples at, and a few last places beside, a step's value, and all voxels that interpolate them.
TEST(PlateauGrid, PlateausStayOnTheirSideOfAStep) {
  const auto saturated = [](double x, double y, double z) {
    return 0.5 + 0.5 * std::tanh(8 * (std::sqrt(x * x + y * y + z * z) - 0.5));
  };
  const scene::ImageSize size{40, 32};
  const auto sides = [](double step) {
    return std::vector<scene::Knot>{{step, {1, 0.2, 0}, 0.1}, {step, {0, 0.3, 1}, 2}};
  };
  const scene::Grid grid = grid_of(32);
  const auto floats = volume_of<float>(grid, saturated);
  float step = 1;
  for (const int places : {0, 1, 16, 256}) {
    for (int i = 0; i < places; ++i) step = std::nextafter(step, 0.0f);
    expect_right(*floats, sides(step), size, "float, step at " + std::to_string(step));
    step = 1;
  }
  const auto bytes =
      volume_of<std::uint8_t>(grid, [&](double x, double y, double z) { return std::round(255 * saturated(x, y, z)); });
  expect_right(*bytes, sides(255), size, "uint8");
  expect_right(*bytes, sides(0), size, "uint8, at 0");
  const auto words = volume_of<std::uint16_t>(
      grid, [&](double x, double y, double z) { return std::round(65535 * saturated(x, y, z)); });
  expect_right(*words, sides(65535), size, "uint16");
  const auto doubles = volume_of<double>(grid, [&](double x, double y, double z) {
    return std::min(saturated(x, y, z), 0.9) == 0.9 ? 1 - 0x1p-50 : saturated(x, y, z);
  });
  expect_right(*doubles, sides(1), size, "double, just below the step");
  const auto small =
      volume_of<float>(grid, [&](double x, double y, double z) { return x > 0 ? -1e-12 : 100 * saturated(x, y, z); });
  expect_right(*small, sides(0), size, "float, just below a step at 0");
  const auto cells = volume_of<double>(grid_of(32, scene::Association::cell),
                                       [&](double x, double, double) { return x > 0 ? 1 : 1 - 0x1p-52; });
  expect_right(*cells, sides(1), size, "cells of doubles");
}

}  // namespace
}  // namespace tessera
