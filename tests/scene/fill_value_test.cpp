// SPDX-License-Identifier: BSD-3-Clause
#include "scene/fill_value.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace tessera::scene::fill_value_test {
namespace {

std::optional<FillValue> found_in(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return find_fill_value(values, *low, *high);
}

TEST(FillValues, AreUsualValuesFarFromAllOthers) {
  for (const double fill : {65535.0, 32767.0, -9999.0, -999.25, -32768.0, 99999.0, 1e20, -3.4028234663852886e38,
                            9.969209968386869e36, std::numeric_limits<double>::max()}) {
    const std::optional<FillValue> found = found_in({1, fill, 5, 3, fill, 7.5});
    ASSERT_TRUE(found.has_value()) << fill;
    EXPECT_EQ(found->value, fill);
    EXPECT_EQ(found->count, 2u);
    EXPECT_EQ(found->others.low, 1);
    EXPECT_EQ(found->others.high, 7.5);
    EXPECT_EQ(found->is_huge(), std::abs(fill) >= 1e20);
  }
}

TEST(FillValues, SeveralAreListedHugeOnesFirst) {
  const std::vector<double> both = {1, -9999, 5, -32768, -9999, 7};
  const std::optional<FillValue> two = found_in(both);
  ASSERT_TRUE(two.has_value());
  EXPECT_EQ(two->values, (std::vector<double>{-32768, -9999}));
  EXPECT_EQ(two->count, 3u);
  EXPECT_EQ(two->others.low, 1);
  EXPECT_NE(words_on(*two, "samples").find("3 samples have the values -32768 or -9999, which look like fill values"),
            std::string::npos);
  EXPECT_NE(words_on(*two, "samples").find("`threshold` 0.94,7.06 leaves"), std::string::npos);
  std::vector<double> with_huge = both;
  with_huge.insert(with_huge.end(), {1e20, 1e20, -1e30});
  const std::optional<FillValue> huge = found_in(with_huge);
  ASSERT_TRUE(huge.has_value());
  EXPECT_TRUE(huge->is_huge());
  EXPECT_EQ(huge->values, (std::vector<double>{-1e30, 1e20}));
  EXPECT_EQ(huge->count, 3u);
  EXPECT_EQ(huge->others.low, -32768);  // for a note
  EXPECT_EQ(huge->others.high, 7);
}

TEST(FillValues, ExcludeValuesThatOthersAreNear) {
  EXPECT_FALSE(found_in({-999, 4000, 0, -500}));                 // separated from the others by half of their range
  EXPECT_FALSE(found_in({-4000, 2, 100}));                       // not a common fill value
  EXPECT_FALSE(found_in({1e20, 3e19, 2e19, 5e18}));              // a quantity of that magnitude
  EXPECT_FALSE(found_in({-9999, -9999, -9999}));                 // no other values
  EXPECT_FALSE(found_in({-9999, 1, 1, 1}));                      // otherwise constant: perhaps a label
  EXPECT_FALSE(found_in({0, 1, 2, std::nextafter(9999.0, 0)}));  // 9998.99...
}

TEST(FillValues, OfSamplesAreFoundWithScaleAndBlanks) {
  Grid grid;
  grid.geometry.points = {2, 2, 2};
  grid.scale = 2, grid.shift = 1;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto source = MemorySource::of(grid, std::vector<double>{-5000, 1, 2, nan, 3, 4, -5000, 5});
  const std::optional<FillValue> found = find_fill_value(*source, value_range(*source));
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->value, -9999);
  EXPECT_EQ(found->count, 2u);
  EXPECT_EQ(found->others.low, 3);
  EXPECT_EQ(found->others.high, 11);
  EXPECT_NE(words_on(*found, "samples").find("2 samples have the value -9999, "), std::string::npos);
  EXPECT_NE(words_on(*found, "samples").find("`threshold` 2.92,11.08 leaves"), std::string::npos);
}

}  // namespace
}  // namespace tessera::scene::fill_value_test
