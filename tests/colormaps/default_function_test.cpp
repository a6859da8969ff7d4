// SPDX-License-Identifier: BSD-3-Clause
#include "colormaps/default_function.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <set>
#include <tuple>

#include "colormaps/pilot_pixels.hpp"

namespace tessera::colormaps {
namespace {

constexpr int side = 16;  // as many as pilot pixels along a side

/// A cube of edge 1 with a sample in each of 16^3 voxels.
scene::FieldSamples cube_of(const auto& value) {
  scene::FieldSamples out{{}, glm::dvec3(1), 1};
  for (int k = 0; k < side; ++k)
    for (int j = 0; j < side; ++j)
      for (int i = 0; i < side; ++i) {
        const auto at = [](int n) { return (static_cast<float>(n) + 0.5F) / side; };
        out.samples.push_back({value(at(i), at(j), at(k)), 1.0F / (side * side * side), {at(i), at(j), at(k)}, 0});
      }
  return out;
}

TransferFunctionOptions options_over(double low, double high) {
  TransferFunctionOptions options;
  options.field_range = {low, high};
  options.default_unit_distance = 0.1;
  return options;
}

TEST(DefaultFunction, AnOutlierDoesNotDecideTheRange) {
  const auto samples = cube_of([](float x, float y, float) {
    return y > 0.99F ? 0 : x < 0.04F && y < 0.04F ? 1e6 : x;
  });
  const DefaultField field{&samples};
  const DefaultRange range = default_range(field, ValueShares(*field.samples), {0, 1e6});
  EXPECT_LT(range.high, 1);
  EXPECT_GE(range.low, 0);
}

TEST(DefaultFunction, PixelsHaveTheTargetOpacityByBeerLambert) {
  // The extinction is uniform. Each pixel's optical depth is extinction times the edge, so the factor is known.
  const auto samples = cube_of([](float, float, float) { return 1.0; });
  const std::array<std::array<double, 2>, 1> extinction{{{1, 2}}};
  const PilotPixels pixels(samples, extinction, 1);
  EXPECT_NEAR(pixels.scale(0.3), -std::log(0.7) / 2, 1e-3);
}

TEST(DefaultFunction, LabelsGetAColourEachAndAGridsZeroIsClear) {
  const auto samples = cube_of([](float x, float, float) { return std::floor(x * 5); });
  const auto function = default_function({&samples, true}, options_over(0, 4)).function;
  std::set<std::tuple<double, double, double>> colors;
  for (int label = 0; label < 5; ++label) {
    const Knot at = function.evaluate(label);
    EXPECT_EQ(at.extinction > 0, label > 0);
    EXPECT_EQ(at.color, function.evaluate(label + (label < 4 ? 0.4 : 0)).color);
    colors.insert({at.color.x, at.color.y, at.color.z});
  }
  EXPECT_EQ(colors.size(), 5u);
  EXPECT_GT(default_function({&samples, false}, options_over(0, 4)).function.evaluate(0).extinction, 0);
}

TEST(DefaultFunction, LabelsHaveNoOpacityBetweenThemAndAColourEach) {
  const auto samples = cube_of([](float x, float, float) { return x < 0.5F ? 1.0 : 9.0; });
  const DefaultField field{.samples = &samples, .is_grid = true, .labels = std::vector<double>{0, 1, 9}};
  const LoadedTransferFunction loaded = default_function(field, options_over(0, 9));
  EXPECT_GT(loaded.function.evaluate(1).extinction, 0);
  EXPECT_GT(loaded.function.evaluate(9).extinction, 0);
  EXPECT_EQ(loaded.function.evaluate(0).extinction, 0);
  for (int absent = 2; absent < 9; ++absent) EXPECT_EQ(loaded.function.evaluate(absent).extinction, 0) << absent;
  std::vector<double> many(100);
  std::iota(many.begin(), many.end(), 1);
  const DefaultField atlas{.samples = &samples, .is_grid = true, .axes = BodyAxes::ras, .labels = many};
  ASSERT_EQ(default_kind(atlas, {1, 100}), DefaultKind::labels);
  const auto function = default_function(atlas, options_over(1, 100)).function;
  for (int label = 1; label < 100; ++label) {
    EXPECT_GT(function.evaluate(label).extinction, 0) << label;
    EXPECT_NE(function.evaluate(label).color, function.evaluate(label + 1).color) << label;
  }
  // The values are known not to be labels, however few different values there are.
  EXPECT_EQ(default_kind({.samples = &samples, .is_grid = true, .labels = std::vector<double>()}, {1, 9}),
            DefaultKind::values);
}

TEST(DefaultFunction, OtherModalitiesAreNotDrawnAsCt) {
  const auto samples = cube_of([](float x, float, float) { return x < 0.5F ? -1000 : 1500.0 * x - 800.5; });
  DefaultField field{.samples = &samples, .is_grid = true, .axes = BodyAxes::lps, .modality = "MR"};
  EXPECT_EQ(default_kind(field, {-1000, 700}), DefaultKind::body);
  field.modality = "CT", field.axes = BodyAxes::none;
  EXPECT_EQ(default_kind(field, {-1000, 700}), DefaultKind::ct);
}

TEST(DefaultFunction, AirOfACtIsClearAndBoneIsDenserThanMuscle) {
  const auto samples = cube_of([](float x, float, float) { return x < 0.5F ? -1000 : 1500.0 * x - 800.5; });
  const DefaultField field{&samples, true, false, BodyAxes::lps};
  ASSERT_EQ(default_kind(field, {-1000, 700}), DefaultKind::ct);
  const LoadedTransferFunction loaded = default_function(field, options_over(-1000, 700));
  EXPECT_TRUE(loaded.shaded);
  EXPECT_EQ(loaded.function.evaluate(-950).extinction, 0);
  EXPECT_GT(loaded.function.evaluate(600).extinction, 3 * loaded.function.evaluate(40).extinction);
  EXPECT_NE(default_kind({&samples, true}, {-1000, 700}), DefaultKind::ct);  // not of a patient
}

TEST(DefaultFunction, TheGroundOfAGridIsClear) {
  const auto samples = cube_of([](float x, float, float z) { return x < 0.6F ? 0.01 * z : x; });
  const DefaultRange range = default_range({&samples, true}, ValueShares(samples), {0, 1});
  EXPECT_TRUE(range.has_ground);
  EXPECT_FALSE(default_range({&samples, false}, ValueShares(samples), {0, 1}).has_ground);
  const auto function = default_function({&samples, true}, options_over(0, 1)).function;
  EXPECT_EQ(function.evaluate(0.005).extinction, 0);
  EXPECT_GT(function.evaluate(0.8).extinction, 0);
}

TEST(DefaultFunction, SignedFieldsAreShownAboutZero) {
  const auto samples = cube_of([](float x, float, float) { return 3.0 * x - 1; });
  const DefaultRange range = default_range({&samples}, ValueShares(samples), {-1, 2});
  EXPECT_TRUE(range.about_zero);
  EXPECT_EQ(range.low, -range.high);
}

TEST(DefaultFunction, TheOrderOfSamplesChangesNoBit) {
  auto samples = cube_of([](float x, float y, float z) { return std::sin(9 * x) * y + z; });
  const ValueShares shares(samples);
  std::reverse(samples.samples.begin(), samples.samples.end());
  const ValueShares reversed(samples);
  for (const double q : {0.0, 0.005, 0.3, 0.77, 1.0}) EXPECT_EQ(shares.quantile(q), reversed.quantile(q));
  EXPECT_EQ(shares.between(0.1, 0.9), reversed.between(0.1, 0.9));
}

TEST(DefaultFunction, PointsOfAnOpacityCurveAreFractionsOfTheRange) {
  const auto samples = cube_of([](float x, float, float) { return 10.25 * x; });
  TransferFunctionOptions options = options_over(0, 10);
  options.range = {{2, 6}};
  options.opacity_points = {{0, 0}, {0.5, 0.5}, {1, 0.5}};
  const auto function = default_function({&samples}, options).function;
  EXPECT_EQ(function.evaluate(2).extinction, 0);
  EXPECT_NEAR(function.evaluate(4).extinction, std::log(2) / 0.1, 0.01 * std::log(2) / 0.1);
  EXPECT_EQ(function.evaluate(6).extinction, function.evaluate(9).extinction);
}

TEST(FarOff, DetectsFunctionsThatMissTheField) {
  EXPECT_TRUE(is_far_off({0, 1}, {0, 1e5}));
  EXPECT_TRUE(is_far_off({0, 1}, {2, 3}));
  EXPECT_TRUE(is_far_off({0, 1}, {0.5, 0.501}));
  EXPECT_FALSE(is_far_off({0, 1}, {0, 1}));
  EXPECT_FALSE(is_far_off({0, 1}, {0.1, 0.8}));
  EXPECT_FALSE(is_far_off({0.5, 0.5001}, {0, 1}));  // a threshold
}

}  // namespace
}  // namespace tessera::colormaps
