// SPDX-License-Identifier: BSD-3-Clause
#include "projection/clear_intervals.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tessera::projection::clear_intervals_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Scalars at which the result may change: knots, numbers adjacent to knots, and some between and beyond the knots.
std::vector<double> telling_scalars(const scene::TransferFunction& function, std::mt19937& random) {
  std::vector<double> scalars{-1e300, 1e300, 0, std::numeric_limits<double>::denorm_min()};
  for (const scene::Knot& k : function.knots())
    for (const double v : {k.value, std::nextafter(k.value, -infinity), std::nextafter(k.value, infinity),
                           k.value + 1e-17, k.value - 1e-17, k.value - 1e-9, k.value + 1e-9})
      scalars.push_back(v);
  std::uniform_real_distribution<double> between(function.knots().front().value - 1, function.knots().back().value + 1);
  for (int i = 0; i < 8; ++i) scalars.push_back(between(random));
  return scalars;
}

void expect_same_as_visible(const scene::TransferFunction& function, std::mt19937& random) {
  const std::vector<double> scalars = telling_scalars(function, random);
  for (const bool independent : {false, true}) {
    const ClearIntervals clear(function, independent);
    for (const double low : scalars)
      for (const double high : scalars) {
        if (low > high) continue;
        ASSERT_EQ(clear.hold(low, high), !function.visible(low, high, independent))
            << low << " to " << high << ", " << function.knots().size() << " knots, independent " << independent;
        bool meets = false;
        for (const auto& i : clear.meeting(low, high)) {
          meets = true;
          EXPECT_TRUE(i.low <= high && i.high >= low);
        }
        EXPECT_TRUE(meets || !clear.hold(low, high));
      }
  }
}

TEST(ClearIntervals, HideWhatTheTransferFunctionHides) {
  constexpr std::uint32_t seed = 11;
  std::mt19937 random(seed);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (int trial = 0; trial < 300; ++trial) {
    std::vector<scene::Knot> knots;
    double value = pick(5) - 3;
    for (int k = 0, n = 1 + pick(8); k < n; ++k) {
      const double extinction = pick(2) == 0 ? 0 : pick(3) == 0 ? 1e-320 : 0.5 * pick(4);
      knots.push_back({value, glm::dvec3(pick(3) == 0 ? 0 : 1), extinction});
      switch (pick(5)) {
        case 0:
          break;  // a step
        case 1:
          value = std::nextafter(value, infinity);
          break;
        case 2:
          value += 1e-9;
          break;
        default:
          value += 0.5 + pick(2);
      }
    }
    expect_same_as_visible(scene::TransferFunction(knots), random);
    if (HasFatalFailure()) return;
  }
}

TEST(ClearIntervals, EndsAreThoseOfRoundedInterpolation) {
  std::mt19937 random(5);
  // Just below 0, the fraction between the knots rounds to one, and therefore the function to zero.
  expect_same_as_visible(scene::TransferFunction({{-1, {1, 1, 1}, 1}, {0, {1, 1, 1}, 0}, {1, {1, 1, 1}, 1}}), random);
  expect_same_as_visible(scene::TransferFunction({{-1e300, {0, 0, 0}, 0}, {1e300, {1, 1, 1}, 1}}), random);
}

TEST(ClearIntervals, ExcludeABoundaryFromTheIntervalBelowIt) {
  const scene::TransferFunction clear({{0, {1, 1, 1}, 0}, {1, {1, 1, 1}, 0}});
  const std::vector<double> boundaries{-1, 0.25, 0.25, 1};
  const ClearIntervals parted(clear, false, boundaries);
  EXPECT_TRUE(parted.hold(0.25, 0.9));
  EXPECT_TRUE(parted.hold(-0.5, std::nextafter(0.25, 0)));
  EXPECT_FALSE(parted.hold(-0.5, 0.25));
  EXPECT_FALSE(parted.hold(std::nextafter(0.25, 0), 0.25));
  EXPECT_FALSE(parted.hold(0.9, 1));
  EXPECT_TRUE(parted.hold(1, 1e300));
  EXPECT_TRUE(parted.hold(-1e300, -2));
  EXPECT_TRUE(ClearIntervals(clear, false).hold(-2, 2));
}

TEST(ClearIntervals, AnEmptyFunctionHidesEverything) {
  EXPECT_TRUE(ClearIntervals(scene::TransferFunction(), false).hold(-infinity, infinity));
}

}  // namespace
}  // namespace tessera::projection::clear_intervals_test
