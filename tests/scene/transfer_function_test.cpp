// SPDX-License-Identifier: BSD-3-Clause
#include "scene/transfer_function.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "scene/error.hpp"

namespace tessera::scene {
namespace {

TEST(TransferFunction, IsLinearBetweenKnotsAndClampedOutside) {
  const TransferFunction f({{0, {0, 0, 0}, 0}, {2, {1, 0.5, 0}, 4}});
  EXPECT_DOUBLE_EQ(f.evaluate(0.5).extinction, 1);
  EXPECT_DOUBLE_EQ(f.evaluate(0.5).color.y, 0.125);
  EXPECT_DOUBLE_EQ(f.evaluate(-1).extinction, 0);
  EXPECT_DOUBLE_EQ(f.evaluate(9).extinction, 4);
}

TEST(TransferFunction, IsRightContinuousAtAStep) {
  const TransferFunction f({{0, {0, 0, 0}, 1}, {1, {0, 0, 0}, 1}, {1, {1, 1, 1}, 5}, {2, {1, 1, 1}, 5}});
  EXPECT_DOUBLE_EQ(f.evaluate(1).extinction, 5);
  EXPECT_NEAR(f.evaluate(1 - 1e-12).extinction, 1, 1e-9);
}

TEST(TransferFunction, KeepsOnlyTheEndsOfManyKnotsAtOneValue) {
  const TransferFunction f({{1, {0, 0, 0}, 1}, {1, {0, 0, 0}, 2}, {1, {0, 0, 0}, 3}});
  EXPECT_EQ(f.knots().size(), 2u);
  EXPECT_DOUBLE_EQ(f.evaluate(1).extinction, 3);
  EXPECT_DOUBLE_EQ(f.evaluate(0).extinction, 1);
}

TEST(TransferFunction, VisibleOnlyWhereExtinctionIsPositive) {
  const TransferFunction f({{0, {1, 1, 1}, 0}, {1, {1, 1, 1}, 0}, {2, {1, 1, 1}, 3}, {3, {1, 1, 1}, 0}});
  EXPECT_FALSE(f.visible(-5, 1));
  EXPECT_TRUE(f.visible(-5, 1.001));
  EXPECT_TRUE(f.visible(0, 9));  // the peak is inside
  EXPECT_FALSE(f.visible(3, 9));
  EXPECT_TRUE(f.visible(-5, 0, true));
}

TEST(TransferFunction, AStepsLowerSideAtTheEndOfARangeIsSeen) {
  const TransferFunction f({{0, {1, 1, 1}, 0}, {1, {1, 1, 1}, 2}, {1, {1, 1, 1}, 0}, {2, {1, 1, 1}, 0}});
  EXPECT_TRUE(f.visible(0, 1));
  EXPECT_FALSE(f.visible(1, 2));
}

TEST(TransferFunction, RefusesNegativeUnsortedAndNotFiniteKnots) {
  EXPECT_THROW(TransferFunction(std::vector<Knot>{}), Error);
  EXPECT_THROW(TransferFunction({{0, {0, 0, 0}, -1}}), Error);
  EXPECT_THROW(TransferFunction({{0, {0, -1, 0}, 1}}), Error);
  EXPECT_THROW(TransferFunction({{0, {0, 1e31, 0}, 1}}), Error);
  EXPECT_THROW(TransferFunction({{-1e308, {0, 0, 0}, 1e308}, {1e308, {1, 1, 1}, 1e308}}), Error);
  EXPECT_NO_THROW(TransferFunction({{-1e308, {0, 0, 0}, 1e100}, {1e308, {1e30, 1, 1}, 0}}));
  EXPECT_THROW(TransferFunction({{1, {0, 0, 0}, 1}, {0, {0, 0, 0}, 1}}), Error);
  EXPECT_THROW(TransferFunction({{std::numeric_limits<double>::infinity(), {0, 0, 0}, 1}}), Error);
}

}  // namespace
/// A field of such small values has no finite slopes.
TEST(TransferFunction, KnotsBelowTheSmallestNormalNumberApartAreAStep) {
  const TransferFunction f({{0, glm::dvec3(0), 0}, {1e-320, glm::dvec3(1), 2}, {2e-320, glm::dvec3(0.5), 3}});
  ASSERT_EQ(f.knots().size(), 2u);
  EXPECT_EQ(f.evaluate(-1).extinction, 0);
  EXPECT_EQ(f.evaluate(0).extinction, 3);
  EXPECT_EQ(f.evaluate(3e-320).color, glm::dvec3(0.5));
}

}  // namespace tessera::scene
