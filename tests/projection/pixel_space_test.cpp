// SPDX-License-Identifier: BSD-3-Clause
#include "projection/pixel_space.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <random>
#include <vector>

#include "support/instruction_sets.hpp"

namespace tessera::projection::pixel_space_test {
namespace {

TEST(PixelSpace, ProjectsManyPointsToTheBitsOfOne) {
  constexpr std::uint32_t seed = 21;
  std::mt19937 random(seed);
  std::normal_distribution<double> spread;
  std::vector<glm::dvec3> points;
  for (const double size : {1.0, 1e-20, 1e6, 1e20, 1e150})
    for (int i = 0; i < 301; ++i) points.push_back(glm::dvec3(spread(random), spread(random), spread(random)) * size);
  points.push_back(glm::dvec3(0));
  points.push_back(glm::dvec3(1e308, -1e308, 1e308));
  for (const bool perspective : {false, true}) {
    scene::Camera camera;
    camera.position = {0.3, 2, 4};
    camera.focal_point = {0.1, 0, 0};
    camera.projection = perspective ? scene::ProjectionKind::perspective : scene::ProjectionKind::orthographic;
    camera.view_angle = 37;
    camera.parallel_scale = 1.3;
    const PixelSpace space(camera, {1023, 767});
    tests::for_each_instruction_set([&](const char* name) {
      for (const std::size_t count : {std::size_t{0}, std::size_t{1}, std::size_t{7}, points.size()}) {
        std::vector<PixelVertex> out(count);
        space.project(std::span(points).first(count), out);
        for (std::size_t i = 0; i < count; ++i) {
          const PixelVertex one = space.project(points[i]);
          const auto same = [](double a, double b) {
            return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
          };
          ASSERT_TRUE(same(one.x, out[i].x) && same(one.y, out[i].y) && same(one.w, out[i].w) &&
                      same(one.depth, out[i].depth))
              << name << ", point " << i << (perspective ? ", perspective" : ", orthographic");
        }
      }
    });
  }
}

}  // namespace
}  // namespace tessera::projection::pixel_space_test
