// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/volumes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <vector>

#include "datasets/volume_fields.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

std::vector<float> samples_of(const std::string& kind, const std::map<std::string, double>& parameters) {
  const auto volume = generate_volume(kind, parameters);
  std::vector<float> samples(static_cast<std::size_t>(volume->geometry().all_samples().count()));
  volume->read(volume->geometry().all_samples(), std::span(samples));
  return samples;
}

/// For n^3 samples cut into `parts` bricks along each axis: the fraction of bricks that contain values between `low`
/// and `high`. Adjacent bricks share boundary samples.
double share_shown(const std::vector<float>& samples, std::size_t n, std::size_t parts, float low, float high) {
  const std::size_t side = (n - 1) / parts;
  std::size_t shown = 0;
  for (std::size_t brick = 0; brick < parts * parts * parts; ++brick) {
    const std::size_t x = brick % parts * side, y = brick / parts % parts * side, z = brick / parts / parts * side;
    float least = 2, most = -1;
    for (std::size_t k = z; k <= z + side; ++k)
      for (std::size_t j = y; j <= y + side; ++j)
        for (std::size_t i = x; i <= x + side; ++i) {
          const float value = samples[i + n * (j + n * k)];
          least = std::min(least, value), most = std::max(most, value);
        }
    if (most > low && least < high) ++shown;
  }
  return static_cast<double>(shown) / static_cast<double>(parts * parts * parts);
}

TEST(Volumes, HoldTheirFieldsAtTheirPoints) {
  const std::pair<const char*, double (*)(const glm::dvec3&)> fields[] = {
      {"radial", radial_field}, {"head", head_field}, {"turbulence", turbulence_field}};
  constexpr std::size_t n = 9;
  for (const auto& [kind, field] : fields) {
    const std::vector<float> floats = samples_of(kind, {{"n", n}}), bytes = samples_of(kind, {{"n", n}, {"bits", 8}});
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i) {
          const double value = field(glm::dvec3(i, j, k) / 4.0 - 1.0);
          EXPECT_EQ(floats[i + n * (j + n * k)], static_cast<float>(value)) << kind;
          EXPECT_EQ(bytes[i + n * (j + n * k)], std::lround(255 * value)) << kind;
          EXPECT_TRUE(value >= 0 && value <= 1) << kind;
        }
  }
}

TEST(Volumes, TheRadialFieldFallsEvenlyFromTheMiddleToTheCorners) {
  EXPECT_EQ(radial_field({0, 0, 0}), 1);
  EXPECT_NEAR(radial_field({1, -1, 1}), 0, 1e-15);
  EXPECT_NEAR(radial_field({0, 0.6, 0.8}), 1 - 1 / std::sqrt(3.0), 1e-15);
}

TEST(Volumes, FieldsOfNoiseAreTheSameOnEveryMachine) {
  EXPECT_NEAR(turbulence_field({0.1, -0.2, 0.3}), 0.76699704722982986, 1e-12);
  EXPECT_NEAR(head_field({0.1, -0.6, 0.3}), 0.46072853108719575, 1e-12);
}

// Moloney 2008, Table 6.2 and 6.7.1 (volume_fields.hpp).
TEST(Volumes, HaveAsManyVisibleBricksAsTheVolumesTheyRepresent) {
  constexpr std::size_t n = 129;
  const std::vector<float> head = samples_of("head", {{"n", n}});
  EXPECT_NEAR(share_shown(head, n, 32, 0.25f, 2), 0.406, 0.02);
  EXPECT_NEAR(share_shown(head, n, 16, 0.25f, 2), 0.556, 0.02);
  EXPECT_NEAR(share_shown(head, n, 8, 0.25f, 2), 0.793, 0.03);
  EXPECT_NEAR(share_shown(head, n, 4, 0.25f, 2), 0.981, 0.02);
  const std::vector<float> turbulence = samples_of("turbulence", {{"n", n}});
  EXPECT_NEAR(share_shown(turbulence, n, 16, 0.3f, 0.7f), 0.36, 0.02);
}

TEST(Volumes, NoTwoBricksOfTurbulenceAreAlike) {
  constexpr std::size_t n = 65, side = 8;
  const std::vector<float> samples = samples_of("turbulence", {{"n", n}, {"bits", 8}});
  std::vector<std::vector<float>> bricks;
  for (std::size_t z = 0; z + side < n; z += side)
    for (std::size_t y = 0; y + side < n; y += side)
      for (std::size_t x = 0; x + side < n; x += side) {
        std::vector<float>& brick = bricks.emplace_back();
        for (std::size_t k = z; k < z + side; ++k)
          for (std::size_t j = y; j < y + side; ++j)
            for (std::size_t i = x; i < x + side; ++i) brick.push_back(samples[i + n * (j + n * k)]);
      }
  std::sort(bricks.begin(), bricks.end());
  EXPECT_EQ(std::adjacent_find(bricks.begin(), bricks.end()), bricks.end());
}

TEST(Volumes, ReportsInvalidNamesAndSizes) {
  const auto message = [](const std::string& kind, const std::map<std::string, double>& parameters) -> std::string {
    try {
      generate_volume(kind, parameters);
    } catch (const scene::Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message("skull", {}).find("use ripples, radial, head, turbulence or checker"), std::string::npos);
  EXPECT_NE(message("head", {{"n", 1}}).find("give a whole number from 2 to 4096"), std::string::npos);
  EXPECT_NE(message("turbulence", {{"bits", 12}}).find("give 8, 16 or 32"), std::string::npos);
  EXPECT_NE(message("checker", {{"bits", 8}}).find("it takes n"), std::string::npos);
}

}  // namespace
}  // namespace tessera::datasets
