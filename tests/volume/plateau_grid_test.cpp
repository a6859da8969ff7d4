// SPDX-License-Identifier: BSD-3-Clause
// Blank samples, constant volumes, and plateaus of the field at the value of a step of the transfer function: rounding
// in float lanes must not move a sample, or a voxel, to the wrong side. Compares every pixel with the reference in
// double precision.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "reference/grid/grid_reference.hpp"
#include "reference/judge.hpp"
#include "scene/camera.hpp"
#include "scene/sample_source.hpp"
#include "volume/render.hpp"

namespace tessera::plateau_grid_test {
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

/// A volume with the samples value(x, y, z) over [-1, 1]^3.
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
    for (const IntegratorKind method : {IntegratorKind::exact, IntegratorKind::automatic}) {
      volume::RenderSettings settings;
      settings.integrator.kind = method;
      settings.threads = 2;
      const double bound = method == IntegratorKind::exact ? 1e-5 : 1e-4;
      const scene::Image image = volume::Renderer(source, settings).render(camera, size, function).image;
      const auto judgement = reference::judge(image, truth, bound, {}, 2);
      EXPECT_LE(judgement.max_error_not_excused, bound)
          << what << ", view " << number << ", bound " << bound << ", worst at " << judgement.worst_x << ' '
          << judgement.worst_y;
    }
    ++number;
  }
}

/// Two slabs at once form a line only where both have a field. A maximum that drops NaN once treated whole packets as
/// one line.
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
    const scene::Image whole = renderer.render(camera, size, function).image;
    for (int i = 0; i < 6; ++i) {
      const int x = static_cast<int>(random() % 22) * 4, y = static_cast<int>(random() % 18) * 4;
      const scene::PixelRect region{x, y, std::min(x + 4 + 4 * static_cast<int>(random() % 9), size.width),
                                    std::min(y + 4 + 4 * static_cast<int>(random() % 9), size.height)};
      const scene::Image part = renderer.render(camera, size, function, {.regions = {region}}).image;
      for (int v = region.y0; v < region.y1; ++v)
        for (int u = region.x0; u < region.x1; ++u)
          for (std::size_t c = 0; c < 4; ++c)
            ASSERT_EQ(part.rgba[4 * part.index(u, v) + c], whole.rgba[4 * whole.index(u, v) + c]) << u << ' ' << v;
    }
  }
}

/// A single value has no range from which to derive a unit: knots on both sides of it once became one.
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

/// Samples at, and a few last places away from, a step's value, and all voxels that interpolate them.
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

/// Hash of a position, 0 to n - 1, always the same.
int hashed(double x, double y, double z, int n) {
  return static_cast<int>(std::fmod(std::abs(std::sin(12.9898 * x + 78.233 * y + 37.719 * z)) * 43758.5453, n));
}

/// Doubles that are last places apart, and knots equally close: the image equals that of the same field in units of a
/// last place, relative to 1. Interpolated directly, they would round to whole places.
TEST(PlateauGrid, LastPlacesOfDoublesAreNumbersLikeOthers) {
  const double place = 0x1p-52;
  const scene::ImageSize size{24, 20};
  for (const bool rectilinear : {true, false}) {
    scene::Grid grid = grid_of(9);
    if (rectilinear) grid.geometry.coordinates[1] = {0, 0.1, 0.3, 0.6, 0.7, 1, 1.2, 1.5, 2};
    const auto places = [](double x, double y, double z) { return hashed(x, y, z, 3); };
    const auto near =
        volume_of<double>(grid, [&](double x, double y, double z) { return 1 + places(x, y, z) * place; });
    const auto plain = volume_of<double>(grid, places);
    const auto function = [](double origin, double unit) {
      return scene::TransferFunction({{origin - 3.5 * unit, {0.9, 0.1, 0.3}, 0},
                                      {origin + unit, {0.1, 0.8, 0.2}, 1.5},
                                      {origin + 5 * unit, {0.2, 0.1, 0.9}, 3}});
    };
    const scene::TransferFunction near_function = function(1, place), plain_function = function(0, 1);
    for (const scene::Camera& camera : views_of(*plain, size)) {
      const reference::GridReference near_truth(*near, camera, size, near_function, scene::Emission::absorption),
          truth(*plain, camera, size, plain_function, scene::Emission::absorption);
      volume::RenderSettings settings;
      settings.integrator.kind = IntegratorKind::exact;
      settings.threads = 2;
      const scene::Image image = volume::Renderer(*near, settings).render(camera, size, near_function).image;
      const auto judgement = reference::judge(image, truth, 1e-5, {}, 2);
      EXPECT_LE(judgement.max_error, 1e-5) << judgement.worst_x << ' ' << judgement.worst_y;
      for (int y = 0; y < size.height; y += 3)
        for (int x = 0; x < size.width; x += 3) {
          // Both references integrate the same numbers. Only the coordinates of their grids are rounded, in the same
          // way.
          const auto one = near_truth.pixel(x + 0.5, y + 0.5), other = truth.pixel(x + 0.5, y + 0.5);
          EXPECT_NEAR(one.a, other.a, 1e-11) << x << ' ' << y;
          EXPECT_NEAR(one.r, other.r, 1e-11) << x << ' ' << y;
        }
    }
  }
}

/// Knots that lanes cannot distinguish: the function's values between them, and on either side, are visible where
/// samples are.
TEST(PlateauGrid, KnotsWithinALanesUnitAreAllSeen) {
  const float value = -0.0113818934f;
  const double place = 0x1p-59;
  const scene::ImageSize size{30, 24};
  std::vector<float> values{value};
  for (int n = 0; n < 100; ++n) values.push_back(std::nextafter(values.back(), 0.0f));
  for (const auto association : {scene::Association::point, scene::Association::cell})
    for (const bool half : {false, true}) {
      const auto source = volume_of<float>(grid_of(9, association), [&](double x, double y, double z) {
        return half && x < 0 ? value : values[static_cast<std::size_t>(hashed(x, y, z, 101))];
      });
      const double v = value;
      expect_right(*source,
                   {{v - 13 * place, {0.5, 0.5, 0.3}, 0}, {v, {0.3, 0.9, 0.2}, 2}, {v + 8 * place, {0, 0.9, 0.3}, 0.8}},
                   size, "a ramp, a knot and a ramp");
      expect_right(*source,
                   {{v - 13 * place, {0.5, 0.5, 0.3}, 0}, {v, {0.3, 0.9, 0.2}, 2}, {v + 8 * place, {0, 0.9, 0.3}, 0}},
                   size, "a peak");
      expect_right(*source, {{v + place, {0.6, 0.9, 0.1}, 2}, {v + 3 * place, {0.3, 0.8, 0.3}, 0}}, size,
                   "knots beside it");
      const double unit = 0x1p-53, near = v + 40 * unit;
      expect_right(*source,
                   {{v + 12 * unit, {0.6, 0.9, 0.1}, 40},
                    {near, {0.3, 0.8, 0.3}, 0},
                    {near + 30 * unit, {1, 1, 1}, 40},
                    {near + 900 * unit, {1, 1, 1}, 0}},
                   size, "narrow ramps");
    }
}

/// A step of only colour between ramps: its error was once attributed to the ramps, which are almost level.
TEST(PlateauGrid, StepsOfColourAloneAreSteps) {
  const double step = 2.0000038146972656, place = 0x1p-22;
  const auto source = volume_of<float>(grid_of(17), [&](double x, double y, double z) {
    return 1 + std::min(1.0, std::max(0.0, 1 + x + std::sin(3 * y))) + (hashed(x, y, z, 20001) - 10000) * place;
  });
  expect_right(*source,
               {{step, {0.15, 0.23, 0.09}, 0.53}, {step, {0.84, 0.13, 0.41}, 0.53}, {2.176, {0.68, 0.64, 0.12}, 0}},
               {46, 35}, "colours");
}

/// A field of doubles crosses a step and differs from the step's value only in last places. Float lanes leave such rays
/// to double precision, and doubles keep the crossing's position only as a difference from the step.
TEST(PlateauGrid, CrossingsOnAFrayedPlateauKeepTheirPlaces) {
  const double step = 0.21390244162149247, place = 0x1p-55;
  const scene::ImageSize size{40, 32};
  for (const int frayed : {2, 16, 256}) {
    const auto source = volume_of<double>(grid_of(17), [&](double x, double y, double z) {
      return x + 0.3 * y < -0.2 ? 0.5 * (x + 1) * step : step + (hashed(x, y, z, 2 * frayed + 1) - frayed) * place;
    });
    expect_right(*source, {{step, {0.6, 0.7, 0.5}, 2}, {step, {0.5, 0.7, 0.4}, 0}}, size,
                 "frayed by " + std::to_string(frayed));
    expect_right(*source, {{step - 3.3 * place, {0.6, 0.7, 0.5}, 2}, {step + 7.1 * place, {0.5, 0.7, 0.4}, 0}}, size,
                 "a ramp in the fray of " + std::to_string(frayed));
  }
}

/// The field is continuous: a ray in a plane of the lattice has the plane's values, whatever is next to it.
TEST(PlateauGrid, RaysInALatticePlaneHaveItsValues) {
  const scene::ImageSize size{9, 9};
  const auto source = volume_of<std::uint16_t>(grid_of(13), [](double x, double y, double z) {
    return std::abs(y) < 1e-9 ? 27465 : hashed(x, y, z, 2) == 0 ? 20533 : 48263;
  });
  const double extinction = 3;
  const scene::TransferFunction function({{27465, {0.9, 0.7, 0.6}, 0},
                                          {27465, {0.9, 0.7, 0.6}, extinction},
                                          {27468, {0.9, 0.7, 0.6}, extinction},
                                          {27468, {0.1, 0, 0.2}, 0}});
  for (const bool perspective : {false, true})
    for (const double up : {-1.0, 1.0}) {
      scene::Camera camera;
      camera.position = {9, 0, 0.37}, camera.focal_point = {0, 0, 0.37}, camera.view_up = {0, up, 0};
      if (perspective) camera.projection = scene::ProjectionKind::perspective, camera.view_angle = 11;
      camera.parallel_scale = 0.8;
      const reference::GridReference truth(*source, camera, size, function, scene::Emission::absorption);
      volume::RenderSettings settings;
      settings.integrator.kind = IntegratorKind::exact;
      const scene::Image image = volume::Renderer(*source, settings).render(camera, size, function).image;
      const std::size_t middle = image.index(4, 4);
      const double alpha = 1 - std::exp(-2 * extinction);  // the middle pixel's ray goes along x through the whole grid
      EXPECT_NEAR(image.rgba[4 * middle + 3], alpha, 1e-5);
      EXPECT_NEAR(truth.pixel(4.5, 4.5).a, alpha, 1e-12);
    }
}

/// Rays in a plane of the lattice, with blanks on one side of it in some voxels and on the other side in others.
TEST(PlateauGrid, RaysInALatticePlaneStayOnOneSide) {
  const scene::ImageSize size{17, 17};
  const auto source = volume_of<double>(grid_of(13), [](double x, double y, double z) {
    return std::abs(x + 1.3 * y - 0.7 * z) < 0.15 ? blank : 0.5 + 0.4 * std::sin(3 * x + y) * std::cos(2 * z - y);
  });
  std::vector<scene::Knot> many;
  for (int n = 0; n <= 200; ++n) many.push_back({n / 200.0, {0.3, 0.5, 0.9}, n % 3 == 0 ? 6.0 : 0});
  // Doubles for the first, lanes for the second; steep, so that an excusable shift changes more than the bound.
  for (const scene::TransferFunction& function :
       {scene::TransferFunction(many), scene::TransferFunction({{0, {1, 0.5, 0}, 0}, {1, {0, 0.5, 1}, 900}})})
    for (int axis = 0; axis < 3; ++axis)
      for (const double side : {-1.0, 1.0})
        for (const double turned : {-1.0, 1.0})
          for (const bool perspective : {false, true}) {
            scene::Camera camera;
            camera.position = camera.focal_point = camera.view_up = glm::dvec3(0);
            camera.position[axis] = 7.123 * side, camera.view_up[(axis + 1) % 3] = turned;
            if (perspective) camera.projection = scene::ProjectionKind::perspective, camera.view_angle = 23.7;
            camera.parallel_scale = 1.3;
            const reference::GridReference truth(*source, camera, size, function, scene::Emission::absorption);
            volume::RenderSettings settings;
            settings.integrator.kind = IntegratorKind::exact;
            settings.threads = 2;
            const scene::Image image = volume::Renderer(*source, settings).render(camera, size, function).image;
            const auto judgement = reference::judge(image, truth, 1e-5, {}, 2);
            EXPECT_LE(judgement.max_error_not_excused, 1e-5)
                << axis << ' ' << side << ' ' << turned << ' ' << perspective << ", worst at " << judgement.worst_x
                << ' ' << judgement.worst_y;
          }
}

/// Lighting depends on the direction of the gradient, however small the gradient is. It is computed from differences of
/// values that floats cannot represent.
void expect_lit_right(const scene::SampleSource& source, const std::string& what) {
  const scene::TransferFunction grey({{0, {0.6, 0.2, 0.4}, 1}, {1, {0.6, 0.2, 0.4}, 1}});
  const scene::ImageSize size{24, 24};
  Surfaces surfaces;
  surfaces.iso = {{0.5, glm::dvec3(0, 0.5, 1), 0.4}};
  const scene::Shading shading{0.2, 0.7, 0.3, 20, {0.4, -0.3, 0.8}, true};
  int number = 0;
  for (const scene::Camera& camera : views_of(source, size))
    for (const bool has_surface : {false, true}) {
      const Surfaces& shown = has_surface ? surfaces : Surfaces();
      volume::RenderSettings settings;
      settings.integrator.kind = IntegratorKind::exact;
      settings.threads = 2;
      settings.grid.shading = shading;
      settings.surfaces = shown;
      const reference::GridReference truth(source, camera, size, grey, scene::Emission::absorption, shading, {}, shown);
      const scene::Image image = volume::Renderer(source, settings).render(camera, size, grey).image;
      EXPECT_LE(reference::judge(image, truth, 1e-5, {}, 2).max_error_not_excused, 1e-5)
          << what << ", view " << number++ << ", surface " << has_surface;
    }
}

TEST(PlateauGrid, IsLitByTheDirectionOfSmallGradients) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-1, 1);
  for (const double differences : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14}) {
    const auto level = [&](double, double, double z) {
      return z < -0.9 ? 0 : z > 0.9 ? 1 : 0.5 + differences * any(random);
    };
    expect_lit_right(*volume_of<double>(grid_of(6), level), fmt::format("doubles, {}", differences));
    if (differences > 1e-7)
      expect_lit_right(*volume_of<float>(grid_of(6), level), fmt::format("floats, {}", differences));
  }
  // Integers with a scale that makes them fractions, as in medical files.
  scene::Grid grid = grid_of(6);
  grid.scale = 1 / 65535.0, grid.shift = 0.1;
  expect_lit_right(*volume_of<std::uint16_t>(grid,
                                             [&](double, double, double z) {
                                               return z < -0.9 ? 0 : z > 0.9 ? 65535 : 26214 + 3 * any(random);
                                             }),
                   "scaled numbers");
}

}  // namespace
}  // namespace tessera::plateau_grid_test
