// SPDX-License-Identifier: BSD-3-Clause
#include "reference/integral.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tessera::reference::integral_test {
namespace {

using scene::Emission;
using scene::Knot;

constexpr double rounding = 1e-14;  // sums of a few hundred terms below one, in double

/// The integral over one segment by Simpson's rule with very many steps between given places, in long double.
std::array<double, 4> simpson(const std::vector<Knot>& knots, Emission emission, double length, double s0, double s1) {
  const int steps = 42000;  // 3,000 steps between knots that are 0.1 apart
  const scene::TransferFunction function(knots);
  const long double h = static_cast<long double>(length) / steps;
  long double optical_depth = 0, color[3] = {0, 0, 0};
  for (int i = 0; i < steps; ++i) {
    const auto knot = [&](double u) { return function.evaluate(s0 + (s1 - s0) * (i + u) / steps); };
    const Knot a = knot(1e-9), m = knot(0.5), b = knot(1 - 1e-9);  // inside the step, so that jumps are between steps
    const long double half = h / 24 * (5 * a.extinction + 8 * m.extinction - b.extinction);
    const long double whole = h / 6 * (a.extinction + 4 * m.extinction + b.extinction);
    for (int c = 0; c < 3; ++c) {
      const auto source = [&](const Knot& k) {
        return k.color[c] * (emission == Emission::absorption ? k.extinction : 1.0L);
      };
      color[c] += h / 6 *
                  (source(a) * std::exp(-optical_depth) + 4 * source(m) * std::exp(-optical_depth - half) +
                   source(b) * std::exp(-optical_depth - whole));
    }
    optical_depth += whole;
  }
  return {static_cast<double>(color[0]), static_cast<double>(color[1]), static_cast<double>(color[2]),
          static_cast<double>(-std::expm1(-optical_depth))};
}

TEST(Integral, HomogeneousSegmentObeysBeerAndLambert) {
  const std::vector<Knot> knots{{0, {0.5, 1, 2}, 3}};
  for (const double length : {1e-9, 0.1, 1.0, 10.0}) {
    Integral integral(knots, Emission::absorption);
    integral.add(length, 0.3, 0.4, 2, 3);
    const double a = -std::expm1(-3 * length);
    EXPECT_NEAR(integral.opacity(), a, a * rounding);
    EXPECT_NEAR(integral.color()[0], 0.5 * a, a * rounding);
    EXPECT_NEAR(integral.color()[2], 2 * a, 2 * a * rounding);
    EXPECT_EQ(integral.first_visible_depth(), 2);
  }
}

TEST(Integral, LinearColourAndConstantExtinction) {
  const std::vector<Knot> knots{{0, {0, 1, 0}, 4}, {1, {1, 0, 0}, 4}};
  Integral integral(knots, Emission::absorption);
  integral.add(1, 0, 1, 0, 1);
  const double a = -std::expm1(-4.0), ramp = a / 4 - std::exp(-4.0);  // int 4 t exp(-4 t) dt
  EXPECT_NEAR(integral.color()[0], ramp, rounding);
  EXPECT_NEAR(integral.color()[1], a - ramp, rounding);
}

TEST(Integral, LinearExtinctionAndConstantColour) {
  for (const double steepness : {1e-6, 1.0, 50.0, 1e4}) {
    const std::vector<Knot> knots{{0, {1, 1, 1}, 0}, {1, {1, 1, 1}, steepness}};
    for (const bool reversed : {false, true}) {
      Integral integral(knots, Emission::absorption);
      integral.add(1, reversed, !reversed, 0, 1);
      const double a = -std::expm1(-steepness / 2);
      EXPECT_NEAR(integral.opacity(), a, a * rounding);
      EXPECT_NEAR(integral.color()[0], a, a * rounding) << steepness << reversed;
      EXPECT_EQ(integral.first_visible_depth(), 0);
    }
  }
}

TEST(Integral, IndependentEmission) {
  const std::vector<Knot> clear{{0, {0.25, 0, 0}, 0}}, dim{{0, {0.25, 0, 0}, 2}};
  Integral without(clear, Emission::independent), with(dim, Emission::independent);
  without.add(3, 1, 1, 0, 3);
  with.add(3, 1, 1, 0, 3);
  EXPECT_NEAR(without.color()[0], 0.75, rounding);
  EXPECT_EQ(without.opacity(), 0);
  EXPECT_TRUE(std::isinf(without.first_visible_depth()));
  EXPECT_NEAR(with.color()[0], 0.25 / 2 * -std::expm1(-6.0), rounding);
}

TEST(Integral, AStepBelongsToItsUpperKnot) {
  const std::vector<Knot> knots{{0, {1, 0, 0}, 1}, {1, {1, 0, 0}, 1}, {1, {0, 1, 0}, 5}, {2, {0, 1, 0}, 5}};
  Integral on_step(knots, Emission::absorption);
  on_step.add(1, 1, 1, 0, 1);
  EXPECT_NEAR(on_step.optical_depth(), 5, rounding);

  Integral across(knots, Emission::absorption), back(knots, Emission::absorption);
  across.add(1, 0.5, 1.5, 0, 1);
  back.add(1, 1.5, 0.5, 0, 1);
  EXPECT_NEAR(across.optical_depth(), 3, rounding);
  EXPECT_NEAR(across.color()[0], -std::expm1(-0.5), rounding);
  EXPECT_NEAR(across.color()[1], std::exp(-0.5) * -std::expm1(-2.5), rounding);
  EXPECT_NEAR(back.color()[1], -std::expm1(-2.5), rounding);

  Integral up_to(knots, Emission::absorption), from(knots, Emission::absorption);
  up_to.add(1, 0, 1, 0, 1);  // reaches the step, never crosses it
  from.add(1, 1, 2, 0, 1);
  EXPECT_NEAR(up_to.optical_depth(), 1, rounding);
  EXPECT_NEAR(from.optical_depth(), 5, rounding);
}

TEST(Integral, ClampsOutsideTheKnotsAndFindsWhereVisibilityBegins) {
  const std::vector<Knot> knots{{1, {1, 1, 1}, 0}, {2, {1, 1, 1}, 0}, {3, {1, 1, 1}, 4}};
  Integral integral(knots, Emission::absorption);
  integral.add(1, -5, 0, 10, 11);
  EXPECT_TRUE(std::isinf(integral.first_visible_depth()));
  integral.add(4, 0, 4, 11, 15);
  EXPECT_DOUBLE_EQ(integral.first_visible_depth(), 13);
  EXPECT_NEAR(integral.optical_depth(), 2 + 4, rounding * 6);
}

TEST(Integral, OpticallyThickSegmentsAreRightAndFast) {
  const std::vector<Knot> knots{{0, {0.5, 0.5, 0.5}, 1e12}, {1, {0.5, 1, 0.5}, 3e12}};
  for (const auto& [s0, s1] : {std::array{0.0, 1.0}, std::array{1.0, 0.0}, std::array{0.5, 0.5}}) {
    Integral integral(knots, Emission::absorption);
    integral.add(1, s0, s1, 0, 1);
    EXPECT_EQ(integral.opacity(), 1);
    EXPECT_NEAR(integral.color()[0], 0.5, rounding);
    EXPECT_NEAR(integral.color()[1], 0.5 + s0 / 2, 2e-12);  // absorbed within 1e-12 of its front
  }
}

TEST(Integral, TwoMaterialsAddUpFrontToBack) {
  const std::vector<Knot> knots{{0, {1, 0, 0}, 2}, {1, {1, 0, 0}, 2}, {1, {0, 0, 1}, 7}};
  Integral integral(knots, Emission::absorption);
  integral.add(0.25, 0, 0, 0, 0.25);
  integral.add(0.5, 3, 3, 0.25, 0.75);
  EXPECT_NEAR(integral.color()[0], -std::expm1(-0.5), rounding);
  EXPECT_NEAR(integral.color()[2], std::exp(-0.5) * -std::expm1(-3.5), rounding);
  EXPECT_NEAR(integral.opacity(), -std::expm1(-4.0), rounding);
}

TEST(Integral, AgreesWithSimpsonOnRandomTransferFunctions) {
  for (const unsigned seed : {1u, 2u, 3u, 4u}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    std::vector<Knot> knots;
    for (int i = 0; i < 12; ++i) {
      // Values on a grid that contains the ends of the Simpson steps, some of them twice.
      const double value = i / 2 * 0.2 - (i % 3 == 0 ? 0.1 : 0);
      knots.push_back({value, {unit(random), unit(random), unit(random)}, 8 * unit(random)});
    }
    std::sort(knots.begin(), knots.end(), [](const Knot& a, const Knot& b) { return a.value < b.value; });
    for (const Emission emission : {Emission::absorption, Emission::independent})
      for (const auto& [s0, s1] : {std::array{-0.2, 1.2}, std::array{1.2, -0.2}}) {
        Integral integral(knots, emission);
        integral.add(1.5, s0, s1, 0, 1);
        const std::array<double, 4> truth = simpson(knots, emission, 1.5, s0, s1);
        // The error of Simpson's rule: values are taken 1e-9 inside the steps, with slopes of up to 100 and 42,000
        // steps.
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(integral.color()[c], truth[c], 1e-11) << "seed " << seed;
        EXPECT_NEAR(integral.opacity(), truth[3], 1e-11) << "seed " << seed;
      }
  }
}

TEST(Integral, SplittingASegmentChangesNothing) {
  std::vector<Knot> knots;
  for (int i = 0; i <= 40; ++i)
    knots.push_back({i / 40.0, {std::abs(std::sin(i)), std::abs(std::cos(i)), 0.5}, i % 5 * 1.5});
  Integral whole(knots, Emission::absorption), parts(knots, Emission::absorption);
  whole.add(2, 0.03, 0.97, 1, 3);
  for (int i = 0; i < 100; ++i)
    parts.add(0.02, 0.03 + 0.94 * i / 100, 0.03 + 0.94 * (i + 1) / 100, 1 + i / 50.0, 1 + (i + 1) / 50.0);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(whole.color()[c], parts.color()[c], rounding * 10);
  EXPECT_NEAR(whole.optical_depth(), parts.optical_depth(), rounding * 10);
}

}  // namespace
}  // namespace tessera::reference::integral_test
