// SPDX-License-Identifier: BSD-3-Clause
// Views, functions and data at the limits of doubles: refused with a message, or rendered to finite numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "api/query_data.hpp"
#include "datasets/arrays.hpp"
#include "datasets/boxes.hpp"
#include "datasets/random.hpp"
#include "scene/error.hpp"
#include "tessera/session.hpp"
#include "tessera/surfaces.hpp"

namespace tessera {
namespace {

using datasets::Random;

Dataset mesh_scaled_by(double factor) {
  scene::TetMesh mesh = datasets::cube(2);
  for (glm::dvec3& p : mesh.positions) p *= factor;
  return Dataset::of(datasets::arrays_of(std::move(mesh)));
}

double any_magnitude(Random& random) {
  const double sign = random.uniform() < 0.5 ? 1 : -1;
  switch (random.below(8)) {
    case 0:
      return 0;
    case 1:
      return sign * std::numeric_limits<double>::denorm_min();
    case 2:
      return sign * std::numeric_limits<double>::max();
    case 3:
      return sign * std::numeric_limits<double>::infinity();
    case 4:
      return std::numeric_limits<double>::quiet_NaN();
    default:
      return sign * std::pow(10.0, random.uniform(-323, 308));
  }
}

/// A view of the unit cube in which some numbers are arbitrary.
Camera any_camera(Random& random) {
  Camera camera;
  camera.position = {0.4, 0.6, 5}, camera.focal_point = {0.5, 0.5, 0.5}, camera.view_up = {0, 1, 0};
  camera.parallel_scale = 1;
  if (random.uniform() < 0.4) camera.projection = ProjectionKind::perspective;
  if (random.uniform() < 0.6) {
    camera.parallel_scale = any_magnitude(random);
    camera.view_angle = random.uniform() < 0.5 ? any_magnitude(random) : 180 - std::pow(10.0, random.uniform(-14, 2));
  }
  if (random.uniform() < 0.3) camera.position[static_cast<int>(random.below(3))] = any_magnitude(random);
  if (random.uniform() < 0.3) camera.focal_point[static_cast<int>(random.below(3))] = any_magnitude(random);
  if (random.uniform() < 0.3) camera.view_up[static_cast<int>(random.below(3))] = any_magnitude(random);
  if (random.uniform() < 0.2) camera.clipping_range = ClippingRange{any_magnitude(random), any_magnitude(random)};
  return camera;
}

/// How many of `count` views were rendered.
std::size_t draw_any(const Dataset& data, const Settings& settings, std::uint64_t seed, std::size_t count) {
  Random random(seed);
  Session session(data, settings);
  const TransferFunction function({{0, {1, 0, 0}, 0.5}, {0.5, {0, 1, 0}, 0}, {1, {0, 0, 1}, 3}});
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const View view{any_camera(random), {33, 21}};
    try {
      const RenderedFrame frame = session.render(view, function, {});
      ++drawn;
      for (const float value : frame.image.rgba) {
        EXPECT_TRUE(std::isfinite(value))
            << "view " << i << ": scale " << view.camera.parallel_scale << ", angle " << view.camera.view_angle
            << ", at " << view.camera.position.x << ' ' << view.camera.position.y << ' ' << view.camera.position.z
            << " to " << view.camera.focal_point.x << ' ' << view.camera.focal_point.y << ' '
            << view.camera.focal_point.z << ", clipped " << view.camera.clipping_range.has_value() << ", kind "
            << static_cast<int>(view.camera.projection);
        if (!std::isfinite(value)) return drawn;
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input) << "view " << i << ": " << error.what();
    }
  }
  return drawn;
}

TEST(ExtremeViews, OfMeshesAreDrawnOrRefused) {
  for (const double factor : {1.0, 1e-300, 1e-150, 1e90, 1e140, 1e150, 1e300}) {
    SCOPED_TRACE(factor);
    const std::size_t drawn = draw_any(mesh_scaled_by(factor), {}, 1, 1500);
    if (factor < 1e150) {
      EXPECT_GT(drawn, factor == 1 ? 300u : 0u);
    } else {
      EXPECT_EQ(drawn, 0u);  // products of depths are infinite
    }
  }
}

TEST(ExtremeViews, OfMeshesWithSurfacesAreDrawnOrRefused) {
  Settings settings;
  settings.surfaces.iso.push_back({0.4, std::nullopt, 0.5});
  settings.surfaces.boundary.push_back({std::nullopt, 0.3});
  EXPECT_GT(draw_any(mesh_scaled_by(1), settings, 2, 1000), 200u);
}

TEST(ExtremeViews, ByTheOtherRasterizerAreDrawnOrRefused) {
  Settings settings;
  settings.mesh.rasterizer = Rasterizer::scanline;
  EXPECT_GT(draw_any(mesh_scaled_by(1), settings, 3, 1000), 100u);
}

TEST(ExtremeViews, OfGridsAreDrawnOrRefused) {
  const Dataset grid = tests::grid_of(6, [](const glm::dvec3& p) { return 0.5 + 0.4 * std::sin(p.x + 2 * p.y * p.z); });
  EXPECT_GT(draw_any(grid, {}, 4, 1000), 200u);
  Settings settings;
  settings.surfaces.iso.push_back({0.4, std::nullopt, 0.5});
  EXPECT_GT(draw_any(grid, settings, 5, 500), 100u);
}

/// A function in which some numbers are arbitrary.
TransferFunction any_function(Random& random) {
  const auto number = [&](double usual) { return random.uniform() < 0.15 ? any_magnitude(random) : usual; };
  std::vector<Knot> knots;
  double value = number(random.uniform(-0.5, 0.5));
  for (std::uint64_t i = 0, count = 1 + random.below(6); i < count; ++i) {
    knots.push_back({value,
                     {number(random.uniform()), number(random.uniform()), number(random.uniform())},
                     std::abs(number(random.uniform(0, 5)))});
    value += std::abs(number(random.uniform(0, 0.5)));
  }
  return TransferFunction(std::move(knots));
}

/// How many of `count` functions were rendered.
std::size_t draw_any_function(const Dataset& data, const Settings& settings, std::uint64_t seed, std::size_t count) {
  Random random(seed);
  Session session(data, settings);
  const View view = data.default_view({33, 21});
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < count; ++i) {
    try {
      const RenderedFrame frame = session.render(view, any_function(random), {});
      ++drawn;
      for (const float value : frame.image.rgba) {
        EXPECT_TRUE(std::isfinite(value)) << "function " << i;
        if (!std::isfinite(value)) return drawn;
      }
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input) << "function " << i << ": " << error.what();
    }
  }
  return drawn;
}

TEST(ExtremeFunctions, AreDrawnOrRefused) {
  const Dataset grid = tests::grid_of(6, [](const glm::dvec3& p) { return 0.5 + 0.4 * std::sin(p.x + 2 * p.y * p.z); });
  Settings independent;
  independent.emission = Emission::independent;
  for (const Settings& settings : {Settings(), independent}) {
    EXPECT_GT(draw_any_function(mesh_scaled_by(1), settings, 6, 600), 30u);
    EXPECT_GT(draw_any_function(grid, settings, 7, 600), 30u);
  }
}

// Without this check, a subnormal or huge scale would lead to pixels of infinite size, and a NaN number of tiles.
TEST(ExtremeViews, PixelsWithoutASizeAreRefused) {
  const Dataset mesh = mesh_scaled_by(1);
  Session session(mesh, {});
  const TransferFunction function({{0, {1, 0, 0}, 0.5}, {1, {0, 0, 1}, 3}});
  Camera camera = mesh.default_camera({48, 48});
  for (const double scale : {1e-310, 5e-324, 1e308}) {
    camera.parallel_scale = scale;
    EXPECT_THROW(static_cast<void>(session.render({camera, {48, 48}}, function, {})), Error) << scale;
  }
  camera.parallel_scale = 1e-300;
  const RenderedFrame near = session.render({camera, {48, 48}}, function, {});
  camera.parallel_scale = 1e-20;  // the same ray for every pixel, within the resolution of positions
  const RenderedFrame far = session.render({camera, {48, 48}}, function, {});
  for (std::size_t i = 0; i < near.image.rgba.size(); ++i)
    ASSERT_NEAR(near.image.rgba[i], far.image.rgba[i], 1e-4) << i;
}

}  // namespace
}  // namespace tessera
