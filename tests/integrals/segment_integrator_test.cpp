// SPDX-License-Identifier: BSD-3-Clause
#include "integrals/segment_integrator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>

#include "scene/error.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::integrals::segment_integrator_test {
namespace {

using scene::Emission;
using scene::Integrator;
using scene::IntegratorKind;
using scene::Knot;
using scene::TransferFunction;

struct Light {
  double r, g, b, optical_depth, transmittance;
  bool operator==(const Light&) const = default;
};
struct Segment {
  double length, front, back;
};

std::vector<Light> integrated(const TransferFunction& f, const std::vector<Segment>& segments, Emission emission,
                              Integrator integrator = {IntegratorKind::exact, 0, 0}) {
  SegmentBatch batch;
  batch.reserve(segments.size());
  for (const Segment& s : segments) {
    batch.length[batch.size] = s.length;
    batch.scalar_front[batch.size] = s.front;
    batch.scalar_back[batch.size] = s.back;
    ++batch.size;
  }
  SegmentIntegrator(f, integrator, emission).integrate(batch);
  std::vector<Light> out;
  for (std::size_t i = 0; i < batch.size; ++i)
    out.push_back({batch.red[i], batch.green[i], batch.blue[i], batch.optical_depth[i], batch.transmittance[i]});
  return out;
}

/// The integral by brute force: many midpoint steps in long double. Error O(steps^-2), plus one step at each jump.
Light brute_force(const TransferFunction& f, const Segment& s, Emission emission, int steps) {
  long double rgb[3] = {0, 0, 0}, depth = 0;
  const long double h = static_cast<long double>(s.length) / steps;
  for (int i = 0; i < steps; ++i) {
    const Knot k = f.evaluate(s.front + (s.back - s.front) * ((i + 0.5) / steps));
    const long double middle = std::exp(-(depth + 0.5L * h * k.extinction));
    for (int c = 0; c < 3; ++c)
      rgb[c] += middle * h * k.color[c] * (emission == Emission::absorption ? k.extinction : 1.0);
    depth += h * k.extinction;
  }
  return {double(rgb[0]), double(rgb[1]), double(rgb[2]), double(depth), double(std::exp(-depth))};
}

TransferFunction random_function(std::mt19937& random, int knots, double extinction, bool steps) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Knot> list;
  for (int i = 0; i < knots; ++i) {
    list.push_back(
        {double(i) / knots, {uniform(random), uniform(random), uniform(random)}, extinction * uniform(random)});
    if (steps && i % 3 == 1)
      list.push_back(
          {double(i) / knots, {uniform(random), uniform(random), uniform(random)}, extinction * uniform(random)});
  }
  return TransferFunction(list);
}

TEST(SegmentIntegrator, HomogeneousMatterFollowsBeerAndLambert) {
  const TransferFunction f({{0, {0.2, 0.5, 1}, 3}});
  for (const double length : {0.0, 1e-12, 0.1, 2.0, 1e3}) {
    const Light light = integrated(f, {{length, 0.3, 0.7}}, Emission::absorption)[0];
    const double a = -std::expm1(-3 * length);
    EXPECT_NEAR(light.r, 0.2 * a, 1e-9);  // thick segments end at a transmittance of 1e-10
    EXPECT_NEAR(light.b, a, 1e-9);
    EXPECT_NEAR(light.transmittance, 1 - a, 1e-9);
    const Light independent = integrated(f, {{length, 0.3, 0.7}}, Emission::independent)[0];
    EXPECT_NEAR(independent.g, 0.5 * a / 3, 1e-9);
  }
}

TEST(SegmentIntegrator, ALinearRampMatchesItsClosedForm) {
  // kappa = k u, c = u along a unit segment: int k u^2 exp(-k u^2 / 2) du, by parts -exp(-k/2) + sqrt(pi/2k)
  // erf(sqrt(k/2)).
  for (const double k : {1e-3, 0.04, 0.09, 0.7, 1.9, 2.1, 10.0, 1e4}) {
    const TransferFunction f({{0, {0, 0, 0}, 0}, {1, {1, 1, 1}, k}});
    const Light light = integrated(f, {{1, 0, 1}}, Emission::absorption)[0];
    const double expected = -std::exp(-k / 2) + std::sqrt(std::acos(-1.0) / (2 * k)) * std::erf(std::sqrt(k / 2));
    EXPECT_NEAR(light.r, expected, 2e-8) << k;  // the quadrature's bound
  }
}

TEST(SegmentIntegrator, AgreesWithBruteForceOnEveryInstructionSet) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(0, 1);
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const int knots : {1, 2, 3, 6, 13, 40, 300})
      for (const double extinction : {1e-6, 1.0, 30.0})
        for (const Emission emission : {Emission::absorption, Emission::independent}) {
          const TransferFunction f = random_function(random, knots, extinction, false);
          std::vector<Segment> segments;
          for (int i = 0; i < 21; ++i)
            segments.push_back({uniform(random), 1.4 * uniform(random) - 0.2, 1.4 * uniform(random) - 0.2});
          segments[3].back = segments[3].front;
          const auto lights = integrated(f, segments, emission);
          for (std::size_t i = 0; i < segments.size(); ++i) {
            const Light expected = brute_force(f, segments[i], emission, 20000);
            // The midpoint rule has an error of h^2 / 24 times the second derivative, which is 30 * 300 at kinks
            // (knots): 3e-6 covers it.
            EXPECT_NEAR(lights[i].r, expected.r, 3e-6);
            EXPECT_NEAR(lights[i].g, expected.g, 3e-6);
            EXPECT_NEAR(lights[i].b, expected.b, 3e-6);
            // The exact integrator stops at a transmittance of 1e-10.
            EXPECT_NEAR(std::exp(-lights[i].optical_depth), expected.transmittance, 3e-6);
          }
        }
  });
}

TEST(SegmentIntegrator, AutoMakesLongerPiecesWithinItsShareOfTheAccuracy) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const double extinction : {1.0, 30.0, 1e3, 1e5})
    for (const int knots : {2, 6, 40}) {
      const TransferFunction f = random_function(random, knots, extinction, true);
      for (int ray = 0; ray < 50; ++ray) {
        std::vector<Segment> segments(8);
        for (Segment& s : segments) s = {uniform(random) * uniform(random), uniform(random), uniform(random)};
        const auto seen = [&](const Integrator& integrator) {
          double light = 0, through = 1;
          for (const Light& s : integrated(f, segments, Emission::absorption, integrator))
            light += through * s.r, through *= std::exp(-s.optical_depth);
          return std::pair(light, through);
        };
        const auto [light, through] = seen({IntegratorKind::exact, 0, 0});
        for (const double accuracy : {1e-2, 1e-3, 1e-4, 1e-5}) {
          const auto fast = seen({.kind = IntegratorKind::automatic, .accuracy = accuracy});
          // Longer pieces and early termination each add an error of accuracy / 64; `exact` itself has an error of
          // 2e-8.
          EXPECT_NEAR(fast.first, light, accuracy / 32 + 2e-8) << extinction << " " << knots << " " << accuracy;
          EXPECT_NEAR(fast.second, through, accuracy / 32 + 2e-8) << extinction << " " << knots << " " << accuracy;
        }
      }
    }
}

TEST(SegmentIntegrator, CuttingASegmentChangesNothing) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const bool steps : {false, true})
    for (const int knots : {2, 6, 50}) {
      const TransferFunction f = random_function(random, knots, 8, steps);
      for (int trial = 0; trial < 200; ++trial) {
        const Segment whole{uniform(random), 1.2 * uniform(random) - 0.1, 1.2 * uniform(random) - 0.1};
        const double u = uniform(random), middle = whole.front + (whole.back - whole.front) * u;
        const auto l = integrated(
            f, {whole, {whole.length * u, whole.front, middle}, {whole.length * (1 - u), middle, whole.back}},
            Emission::absorption);
        EXPECT_NEAR(l[0].r, l[1].r + l[1].transmittance * l[2].r, 2e-8);  // the quadrature's bound
        EXPECT_NEAR(l[0].optical_depth, l[1].optical_depth + l[2].optical_depth, 1e-12);
      }
    }
}

TEST(SegmentIntegrator, AScalarOnAStepTakesTheUpperKnot) {
  const TransferFunction f({{0, {1, 0, 0}, 1}, {0.5, {1, 0, 0}, 1}, {0.5, {0, 1, 0}, 2}, {1, {0, 1, 0}, 2}});
  const Light light = integrated(f, {{1, 0.5, 0.5}}, Emission::absorption)[0];
  EXPECT_DOUBLE_EQ(light.r, 0);
  EXPECT_DOUBLE_EQ(light.optical_depth, 2);
  // A ray through the step passes both sides, in order.
  const Light down = integrated(f, {{2, 0.6, 0.4}}, Emission::absorption)[0];
  EXPECT_NEAR(down.g, 1 - std::exp(-2.0), 1e-12);
  EXPECT_NEAR(down.r, std::exp(-2.0) * (1 - std::exp(-1.0)), 1e-12);
}

TEST(SegmentIntegrator, ASegmentsBitsDoNotDependOnItsNeighbours) {
  std::mt19937 random(29);
  std::uniform_real_distribution<double> uniform(0, 1);
  const TransferFunction f = random_function(random, 9, 20, true);
  std::vector<Segment> segments;
  for (int i = 0; i < 64; ++i)
    segments.push_back({std::pow(10, -6 * uniform(random)), uniform(random), uniform(random)});
  for (const Emission emission : {Emission::absorption, Emission::independent}) {
    const auto together = integrated(f, segments, emission);
    for (std::size_t i = 0; i < segments.size(); ++i) EXPECT_EQ(integrated(f, {segments[i]}, emission)[0], together[i]);
  }
}

TEST(SegmentIntegrator, HugeExtinctionEndsAndIsOpaque) {
  const TransferFunction f({{0, {0, 0, 1}, 0}, {1, {1, 0, 0}, 1e12}});
  for (const Segment& s : {Segment{1, 0, 1}, Segment{1, 1, 0}, Segment{1e6, 0.5, 0.5}}) {
    const Light light = integrated(f, {s}, Emission::absorption)[0];
    EXPECT_LT(light.transmittance, 1e-9);
    EXPECT_NEAR(light.r + light.b, 1, 1e-9);  // red and blue mix to one along the ramp
  }
}

TEST(SegmentIntegrator, SampledConvergesToExactWithTheSquareOfTheStep) {
  std::mt19937 random(31);
  const TransferFunction f({{0, {0, 0.3, 1}, 1}, {1, {1, 0.6, 0}, 3}});
  const Segment s{0.8, 0.1, 0.9};
  const Light exact = integrated(f, {s}, Emission::absorption)[0];
  double last = 0;
  for (const int n : {4, 8, 16, 32}) {
    const double error =
        std::abs(integrated(f, {s}, Emission::absorption, {IntegratorKind::sampled, n, 0})[0].r - exact.r);
    if (last > 0) {
      EXPECT_NEAR(last / error, 4, 0.5);
    }
    last = error;
  }
  const Light fine = integrated(f, {s}, Emission::independent, {IntegratorKind::sampled, 20000, 0})[0];
  EXPECT_NEAR(fine.r, integrated(f, {s}, Emission::independent)[0].r, 1e-8);
}

TEST(SegmentIntegrator, TablesAreExactWhereTheColourIsConstantAndExtinctionLinear) {
  const TransferFunction f({{-1, {0.2, 0.5, 1}, 0.5}, {3, {0.2, 0.5, 1}, 40}});
  std::mt19937 random(41);
  std::uniform_real_distribution<double> scalar(-1, 3), power(-6, 3);
  std::vector<Segment> segments;
  for (int i = 0; i < 200; ++i) segments.push_back({std::pow(10, power(random)), scalar(random), scalar(random)});
  const auto exact = integrated(f, segments, Emission::absorption);
  for (const Integrator& integrator :
       {Integrator{.kind = IntegratorKind::preintegrated, .table_size = 16}, Integrator{IntegratorKind::partial}}) {
    const auto light = integrated(f, segments, Emission::absorption, integrator);
    for (std::size_t i = 0; i < segments.size(); ++i) {
      // The table stores the extinction as a float, with a relative error of 6e-8. The error of the light is this times
      // q exp(-q) for an optical depth q, and q exp(-q) is at most 1 / e.
      EXPECT_NEAR(light[i].r, exact[i].r, 1e-7);
      EXPECT_NEAR(light[i].b, exact[i].b, 1e-7);
      EXPECT_NEAR(light[i].transmittance, exact[i].transmittance, 1e-7);
    }
  }
}

/// The largest difference between the light of random segments and the exact integral.
double table_error(const TransferFunction& f, const std::vector<Segment>& segments, Emission emission,
                   const Integrator& integrator) {
  const auto exact = integrated(f, segments, emission), light = integrated(f, segments, emission, integrator);
  double error = 0;
  for (std::size_t i = 0; i < segments.size(); ++i)
    error = std::max({error, std::abs(light[i].r - exact[i].r), std::abs(light[i].g - exact[i].g),
                      std::abs(light[i].b - exact[i].b), std::abs(light[i].transmittance - exact[i].transmittance)});
  return error;
}

TEST(SegmentIntegrator, PreintegratedConvergesWithTheTablesSize) {
  std::mt19937 random(43);
  std::uniform_real_distribution<double> scalar(0, 1), length(0, 2);
  std::vector<Segment> segments;
  for (int i = 0; i < 2000; ++i) segments.push_back({length(random), scalar(random), scalar(random)});
  // Without kinks in the function, the error is of second order in the distance between entries; with kinks, at least
  // of first order.
  const TransferFunction smooth({{0, {0, 0.3, 1}, 1}, {1, {1, 0.6, 0}, 5}});
  const TransferFunction kinked = random_function(random, 7, 5, false);
  for (const Emission emission : {Emission::absorption, Emission::independent}) {
    const auto error = [&](const TransferFunction& f, int size) {
      return table_error(f, segments, emission, {.kind = IntegratorKind::preintegrated, .table_size = size});
    };
    const double coarse = error(smooth, 16), fine = error(smooth, 64);
    EXPECT_GT(coarse / fine, 10);  // second order gives 16; the position of the largest error between entries varies
    EXPECT_LT(fine, emission == Emission::absorption ? 1e-3 : 2e-3);  // light is at most 1, or at most the length
    const double coarse_kinked = error(kinked, 16), fine_kinked = error(kinked, 64);
    EXPECT_GT(coarse_kinked / fine_kinked, 2.5);
    EXPECT_LT(fine_kinked, 2e-2);
  }
}

TEST(SegmentIntegrator, PreintegratedCutsOffValuesOutsideTheKnots) {
  const TransferFunction f({{0, {0.1, 0.2, 0.9}, 2}, {1, {0.9, 0.5, 0.1}, 2}});
  const TransferFunction step({{0.5, {1, 0, 0}, 3}, {0.5, {0, 1, 0}, 1}}), one({{0.5, {1, 0, 0}, 3}});
  const std::vector<Segment> segments{{1, -5, 6},  {1, 6, -5},    {2, -3, -1},    {0.5, 4, 4},    {0.7, -2, -2},
                                      {1, 0, 1},   {1, -1, 0},    {1, 1, 9},      {3, 0.5, 0.5},  {3, 0.2, 0.5},
                                      {1, 0.5, 2}, {1, 0.8, 0.5}, {1, 0.5, -0.5}, {0, 0.3, 0.31}, {1, 2, 7}};
  const Integrator fine{.kind = IntegratorKind::preintegrated, .table_size = 128};
  // Between the knots, the error is that of the table. It comes from the change of colour along w, in size / 4 steps
  // (second order).
  EXPECT_LT(table_error(f, segments, Emission::absorption, fine), 4e-4);
  // A function that is a single step needs no interpolation in the table.
  EXPECT_LT(table_error(step, segments, Emission::absorption, fine), 1e-9);
  EXPECT_LT(table_error(one, segments, Emission::independent, fine), 1e-9);
}

TEST(SegmentIntegrator, PartialErrsByItsTableOnly) {
  std::mt19937 random(47);
  std::uniform_real_distribution<double> scalar(0, 1), power(-4, 1);
  for (int trial = 0; trial < 5; ++trial) {
    const TransferFunction f = random_function(random, 9, 5, true);
    std::vector<Segment> segments;
    for (int i = 0; i < 500; ++i) segments.push_back({std::pow(10, power(random)), scalar(random), scalar(random)});
    // A segment has at most ten pieces. Each has an error of 1e-6 of a change of colour that is at most 1, attenuated
    // by the matter in front.
    EXPECT_LT(table_error(f, segments, Emission::absorption, {IntegratorKind::partial}), 1e-5);
  }
}

TEST(PsiTable, KeepsItsDocumentedError) {
  // The extinction equals the scalar, and the colour changes from red to blue: the red light comes only from 1 - M.
  std::mt19937 random(53);
  for (const auto& [deepest, bound] : {std::pair{10.0, 1e-5}, {1e3, 2e-2}, {1e6, 2e-2}}) {
    const TransferFunction f({{0, {1, 0, 0}, 0}, {deepest, {0, 0, 1}, deepest}});
    std::uniform_real_distribution<double> scalar(0, deepest);
    std::vector<Segment> segments;
    for (int i = 0; i < 3000; ++i) segments.push_back({1, scalar(random), scalar(random)});
    EXPECT_LT(table_error(f, segments, Emission::absorption, {IntegratorKind::partial}), bound);
  }
}

TEST(SegmentIntegrator, TablesStayFiniteInExtremes) {
  for (const double extinction : {0.0, 1e-12, 1e12}) {
    const TransferFunction f({{0, {0, 0, 1}, 0}, {0.3, {1, 1, 1}, extinction}, {1, {1, 0, 0}, 0}});
    for (const Integrator& integrator :
         {Integrator{.kind = IntegratorKind::preintegrated, .table_size = 32}, Integrator{IntegratorKind::partial}})
      for (const Segment& s : {Segment{1, 0, 1}, Segment{1e6, 1, 0}, Segment{1e-12, 0.3, 0.3}, Segment{1, 0, 0}}) {
        const Light light = integrated(f, {s}, Emission::absorption, integrator)[0];
        EXPECT_GE(light.r, 0);
        EXPECT_LE(light.r, 1 + 1e-6);
        EXPECT_GE(light.transmittance, 0);
        EXPECT_LE(light.transmittance, 1);
      }
  }
}

TEST(SegmentIntegrator, FindsWhereExtinctionBegins) {
  const TransferFunction f({{0, {1, 1, 1}, 0}, {0.4, {1, 1, 1}, 0}, {0.5, {1, 1, 1}, 2}, {0.8, {1, 1, 1}, 0}});
  const SegmentIntegrator integrator(f, {IntegratorKind::exact, 0, 0}, Emission::absorption);
  EXPECT_NEAR(*integrator.first_visible(0, 1), 0.4, 1e-15);
  EXPECT_NEAR(*integrator.first_visible(1, 0), 0.2, 1e-15);
  EXPECT_EQ(*integrator.first_visible(0.45, 0.45), 0);
  EXPECT_FALSE(integrator.first_visible(0, 0.4).has_value());
  EXPECT_FALSE(integrator.first_visible(0.9, 0.9).has_value());
}

}  // namespace
}  // namespace tessera::integrals::segment_integrator_test
