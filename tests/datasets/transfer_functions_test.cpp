// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/transfer_functions.hpp"

#include <gtest/gtest.h>

namespace tessera::datasets {
namespace {

TEST(TransferFunctions, HaveTheKnotsAskedForInsideTheRange) {
  for (const int n : {1, 2, 6, 14, 300}) {
    const auto smooth = smooth_knots(n, {-3, 5}, 7);
    ASSERT_EQ(smooth.knots().size(), static_cast<std::size_t>(n));
    EXPECT_EQ(smooth.knots().front().value, -3);
    EXPECT_EQ(smooth.knots().back().value, n > 1 ? 5 : -3);
    EXPECT_GT(smooth.max_extinction(), 0);
    EXPECT_LE(smooth.max_extinction(), 7);
    const auto steps = step_knots(n, {-3, 5}, 7);
    ASSERT_EQ(steps.knots().size(), 2 * static_cast<std::size_t>(n));
    for (std::size_t i = 0; i < steps.knots().size(); i += 2)
      EXPECT_EQ(steps.knots()[i].value, steps.knots()[i + 1].value);
    EXPECT_GT(steps.knots().front().value, -3);
    EXPECT_LT(steps.knots().back().value, 5);
  }
}

TEST(TransferFunctions, HaveInvisibleStretchesAndRepeat) {
  const auto f = smooth_knots(100), g = smooth_knots(100);
  std::size_t none = 0;
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(f.knots()[i], g.knots()[i]);
    none += f.knots()[i].extinction == 0 ? 1 : 0;
  }
  EXPECT_GT(none, 10u);
  EXPECT_LT(none, 45u);
}

TEST(TransferFunctions, ScaledMultipliesExtinctionAlone) {
  const auto f = benchmark_transfer_function(), g = scaled(f, 1e20);
  for (std::size_t i = 0; i < f.knots().size(); ++i) {
    EXPECT_EQ(g.knots()[i].extinction, 1e20 * f.knots()[i].extinction);
    EXPECT_EQ(g.knots()[i].color, f.knots()[i].color);
    EXPECT_EQ(g.knots()[i].value, f.knots()[i].value);
  }
}

}  // namespace
}  // namespace tessera::datasets
