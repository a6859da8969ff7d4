// SPDX-License-Identifier: BSD-3-Clause
// Round numbers: properties for any range, and results for some ranges.

#include "annotation/ticks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <set>

namespace tessera::annotation {
namespace {

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
  std::vector<std::string> words;
  for (const Tick& tick : ticks) words.push_back(tick.label);
  return words;
}
using Words = std::vector<std::string>;

TEST(Ticks, AreRoundNumbers) {
  EXPECT_EQ(labels(linear_ticks(0, 1, 6)), (Words{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(labels(linear_ticks(0, 1, 5)), (Words{"0.0", "0.5", "1.0"}));
  EXPECT_EQ(labels(linear_ticks(-3.2, 7.1, 6)), (Words{"-2", "0", "2", "4", "6"}));
  EXPECT_EQ(labels(linear_ticks(0, 255, 6)), (Words{"0", "50", "100", "150", "200", "250"}));
  EXPECT_EQ(labels(linear_ticks(0, 3e20, 4)), (Words{"0", "1e20", "2e20", "3e20"}));
  EXPECT_EQ(labels(linear_ticks(1e-9, 2e-9, 6)), (Words{"1e-9", "1.2e-9", "1.4e-9", "1.6e-9", "1.8e-9", "2e-9"}));
  EXPECT_EQ(labels(linear_ticks(7388000.5, 7388002.5, 5)),
            (Words{"7.3880005e6", "7.388001e6", "7.3880015e6", "7.388002e6", "7.3880025e6"}));
  EXPECT_EQ(labels(linear_ticks(-1e-13, 1, 3)), (Words{"0.0", "0.5", "1.0"}));  // not -0.0
  EXPECT_EQ(labels(linear_ticks(42, 42, 5)), (Words{"42"}));
  EXPECT_EQ(labels(logarithmic_ticks(0.01, 100, 5)), (Words{"0.01", "0.1", "1", "10", "100"}));
  EXPECT_EQ(labels(logarithmic_ticks(1e-12, 1e12, 5)), (Words{"1e-10", "1e-5", "1", "1e5", "1e10"}));
  EXPECT_EQ(labels(logarithmic_ticks(2, 5, 5)), (Words{"2", "3", "4", "5"}));
}

TEST(Ticks, OfAnyRangeAreMultiplesOfOneRoundStepInItWithLabelsThatReadBack) {
  std::mt19937_64 random(std::random_device{}());
  const auto seed = random();
  random.seed(seed);
  SCOPED_TRACE(seed);
  std::uniform_real_distribution<double> mantissa(-10, 10), exponent(-280, 280), relative(-11, 1);
  for (int trial = 0; trial < 20000; ++trial) {
    const double low = mantissa(random) * std::pow(10, exponent(random));
    const double high = low + std::abs(low) * std::pow(10, relative(random));
    const int most = 2 + static_cast<int>(random() % 12);
    const std::vector<Tick> ticks = linear_ticks(low, high, most);
    ASSERT_LE(ticks.size(), static_cast<std::size_t>(most)) << low << " " << high;
    // If a step of 2 gives one tick too many, the step is 5, which gives only two fifths as many ticks. One more tick
    // may be missing because of the ends.
    ASSERT_GE(static_cast<double>(ticks.size()), std::floor(0.4 * (most - 1)) - 1 + (most == 2 ? -1 : 0))
        << low << " " << high << " " << most;
    std::set<std::string> different;
    for (std::size_t i = 0; i < ticks.size(); ++i) {
      ASSERT_GE(ticks[i].value, low);
      ASSERT_LE(ticks[i].value, high);
      if (i > 0) {
        ASSERT_GT(ticks[i].value, ticks[i - 1].value);
      }
      different.insert(ticks[i].label);
    }
    ASSERT_EQ(different.size(), ticks.size()) << low << " " << high;
    if (ticks.size() < 3) continue;
    const double step = (ticks.back().value - ticks.front().value) / static_cast<double>(ticks.size() - 1);
    // The values of ticks may be up to 1e11 steps, so digits of their differences cancel.
    const double slack = 1e-6 + 4e-16 * std::max(std::abs(low), std::abs(high)) / step;
    const double digits = std::log10(step), part = std::pow(10, digits - std::floor(digits + slack));
    ASSERT_TRUE(std::abs(part - 1) < 10 * slack || std::abs(part - 2) < 10 * slack || std::abs(part - 5) < 10 * slack)
        << low << " " << high << " step " << step;
    for (const Tick& tick : ticks) {
      ASSERT_NEAR(tick.value / step, std::round(tick.value / step), slack * (1 + std::abs(tick.value / step)))
          << tick.value << " step " << step;
      // The label may differ from the value by a millionth of a step, because values are clamped to the range.
      ASSERT_NEAR(std::strtod(tick.label.c_str(), nullptr), tick.value, slack * step + 4e-16 * std::abs(tick.value))
          << tick.label;
    }
  }
}

TEST(Ticks, OfALogarithmicRangeArePowersOfTenInIt) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> exponent(-250, 250), decades(1, 40);
  for (int trial = 0; trial < 5000; ++trial) {
    const double low = std::pow(10, exponent(random)), high = low * std::pow(10, decades(random));
    const int most = 2 + static_cast<int>(random() % 10);
    const std::vector<Tick> ticks = logarithmic_ticks(low, high, most);
    ASSERT_LE(ticks.size(), static_cast<std::size_t>(most));
    const bool has_two_powers = std::floor(std::log10(high)) - std::ceil(std::log10(low)) >= 1;
    if (!has_two_powers) continue;
    ASSERT_GE(ticks.size(), 2u) << low << " " << high;
    for (const Tick& tick : ticks) {
      ASSERT_GE(tick.value, low);
      ASSERT_LE(tick.value, high);
      ASSERT_NEAR(std::log10(tick.value), std::round(std::log10(tick.value)), 1e-9);
    }
  }
}

TEST(Ticks, RangesTooNarrowForDoublesGetTheirEnds) {
  const double low = 1e6, high = std::nextafter(low, 2e6);
  const std::vector<Tick> ticks = linear_ticks(low, high, 5);
  ASSERT_EQ(ticks.size(), 2u);
  EXPECT_EQ(ticks[0].value, low);
  EXPECT_EQ(ticks[1].value, high);
  EXPECT_LE(linear_ticks(-1.7e308, 1.7e308, 5).size(), 5u);
  EXPECT_GE(linear_ticks(-1.7e308, 1.7e308, 5).size(), 3u);
}

TEST(Ticks, ARoundLengthIsTheLargestThatFits) {
  EXPECT_EQ(round_length(1), 1);
  EXPECT_EQ(round_length(1.99), 1);
  EXPECT_EQ(round_length(2), 2);
  EXPECT_EQ(round_length(4.99), 2);
  EXPECT_EQ(round_length(5), 5);
  EXPECT_EQ(round_length(9.99), 5);
  EXPECT_EQ(round_length(1e20), 1e20);
  EXPECT_EQ(round_length(0.03), 0.02);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> exponent(-290, 290);
  for (int trial = 0; trial < 5000; ++trial) {
    const double limit = std::pow(10, exponent(random)), length = round_length(limit);
    ASSERT_LE(length, limit);
    ASSERT_GT(2.5 * length * (1 + 1e-12), limit);  // the largest ratio of neighbouring lengths is 5 / 2
  }
}

}  // namespace
}  // namespace tessera::annotation
