// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

#include "integrals/integrate_lanes.hpp"
#include "integrals/masked_lanes.hpp"
#include "integrals/segment_integrator.hpp"
#include "reference/integral.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::integrals::lane_integrator_test {
namespace {

using scene::Emission;
using scene::Knot;
using scene::TransferFunction;

/// Scalars in whole units that a float represents exactly, so that float and double use the same function and segments.
struct Segment {
  float length, front, back;
};
struct Light {
  double r, g, b, alpha, optical_depth;
  bool operator==(const Light&) const = default;
};

std::vector<Light> in_lanes(const LaneTable& table, const std::vector<Segment>& segments,
                            void (*integrate)(const LaneTable&, FloatBatch&) = integrate_lanes) {
  FloatBatch batch;
  batch.reserve(segments.size());
  for (const Segment& s : segments) {
    batch.length[batch.size] = s.length;
    batch.scalar_front[batch.size] = s.front;
    batch.scalar_back[batch.size] = s.back;
    ++batch.size;
  }
  integrate(table, batch);
  std::vector<Light> out;
  for (std::size_t i = 0; i < batch.size; ++i)
    out.push_back({batch.red[i], batch.green[i], batch.blue[i], batch.alpha[i], batch.optical_depth[i]});
  return out;
}

std::vector<Light> in_lanes(const TransferFunction& f, const std::vector<Segment>& segments,
                            Emission emission = Emission::absorption) {
  return in_lanes(LaneTable(f, 0, 1, 1, emission), segments);
}

std::vector<Light> in_double(const TransferFunction& f, const std::vector<Segment>& segments,
                             Emission emission = Emission::absorption) {
  SegmentBatch batch;
  batch.reserve(segments.size());
  for (const Segment& s : segments) {
    batch.length[batch.size] = s.length;
    batch.scalar_front[batch.size] = s.front;
    batch.scalar_back[batch.size] = s.back;
    ++batch.size;
  }
  integrate_exact(PiecewiseTable(f), emission, batch);
  std::vector<Light> out;
  for (std::size_t i = 0; i < batch.size; ++i)
    out.push_back(
        {batch.red[i], batch.green[i], batch.blue[i], -std::expm1(-batch.optical_depth[i]), batch.optical_depth[i]});
  return out;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return uniform_(engine_); }
  double logarithmic(double low, double high) { return low * std::pow(high / low, (*this)()); }
  int below(int n) { return std::min(n - 1, static_cast<int>((*this)() * n)); }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
};

float whole(double x) { return static_cast<float>(std::nearbyint(x)); }

/// Knots over [-range / 2, range / 2], not uniform; every third a step, some extinctions zero.
TransferFunction random_function(Random& random, int knots, double range) {
  std::vector<double> values;
  for (int i = 0; i < knots; ++i) values.push_back(whole(range * (random() - 0.5)));
  std::sort(values.begin(), values.end());
  for (int i = 2; i < knots; i += 3) values[i] = values[i - 1];
  std::vector<Knot> list;
  for (const double value : values)
    list.push_back({value, {random(), random(), random()}, random() < 0.25 ? 0.0 : random()});
  return TransferFunction(list);
}

/// Segments with increasing, decreasing and constant scalars; some begin or end at knots. Their optical depth is about
/// `depth` if the extinction is not zero.
std::vector<Segment> random_segments(Random& random, const TransferFunction& f, int count, double depth) {
  const double low = f.knots().front().value, high = f.knots().back().value, range = std::max(1.0, high - low);
  const auto scalar = [&] {
    if (random() < 0.2) return static_cast<float>(f.knots()[random.below(static_cast<int>(f.knots().size()))].value);
    return whole(low + range * (1.2 * random() - 0.1));
  };
  std::vector<Segment> list;
  for (int i = 0; i < count; ++i) {
    Segment s{static_cast<float>(2 * depth * random()), scalar(), scalar()};
    if (random() < 0.3) s.back = whole(s.front + 1e-3 * range * (random() - 0.5));
    if (random() < 0.15) s.back = s.front;
    list.push_back(s);
  }
  return list;
}

/// Bounds, in units of a segment's brightest light (colours are at most 1). Each bound is about six roundings of a
/// float (6e-8) plus the polynomials' 2e-7.
constexpr double light_bound = 5e-7, depth_bound = 5e-7;
/// Bound for a thin segment, in units of its own optical depth. There must be no bias that would be visible in the sum
/// of a thousand thin segments.
constexpr double thin_bound = 1e-6;

void expect_close(const std::vector<Segment>& segments, const std::vector<Light>& lights,
                  const std::vector<Light>& truth, Emission emission = Emission::absorption) {
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const Light &a = lights[i], &b = truth[i];
    SCOPED_TRACE(testing::Message() << "length " << segments[i].length << ", scalars " << std::fixed
                                    << segments[i].front << " to " << segments[i].back);
    // 1 - exp(-q) in double has an error of 1e-16, which is 1e-7 of an optical depth of 1e-9.
    const double brightest = emission == Emission::independent ? segments[i].length : 1;
    const double thin = emission == Emission::independent ? segments[i].length : std::max(1e-9, b.optical_depth);
    const double bound = std::min(light_bound * brightest, thin_bound * thin);
    EXPECT_NEAR(a.r, b.r, bound);
    EXPECT_NEAR(a.g, b.g, bound);
    EXPECT_NEAR(a.b, b.b, bound);
    EXPECT_NEAR(a.alpha, b.alpha, std::min(light_bound, thin_bound * std::max(1e-9, b.optical_depth)));
    if (b.optical_depth < 19)  // near 20, either integrator may have stopped
      EXPECT_NEAR(a.optical_depth, b.optical_depth, depth_bound * b.optical_depth);
    else
      EXPECT_GE(a.optical_depth, 18.9);
  }
}

constexpr int knot_counts[] = {1, 2, 3, 6, 9, 14, 15, 25, 30, 31, 60, 256, 300};

TEST(LaneIntegrator, AgreesWithDoublePrecisionOnEveryInstructionSet) {
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    Random random(101);
    for (const int knots : knot_counts)
      for (const double range : {1e3, 1e6, 2e9})
        for (const double depth : {1e-9, 1e-3, 0.1, 1.0, 5.0, 100.0, 1e4})
          for (const Emission emission : {Emission::absorption, Emission::independent}) {
            SCOPED_TRACE(testing::Message() << knots << " knots, optical depths to " << depth);
            const TransferFunction f = random_function(random, knots, range);
            const auto segments = random_segments(random, f, 61, depth);
            expect_close(segments, in_lanes(f, segments, emission), in_double(f, segments, emission), emission);
          }
  });
}

// The knots are spaced logarithmically: almost all are in one cell of the table's grid, so that searches begin with
// large steps, from other cells too.
TEST(LaneIntegrator, FindsIntervalsOfKnotsCrowdedAtOneEnd) {
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const double sign : {1.0, -1.0})
      for (const int knots : {40, 300, 900}) {
        Random random(static_cast<unsigned>(knots));
        std::vector<Knot> list;
        for (int i = 0; i < knots; ++i) {
          const double value = whole(std::exp2(20.0 * i / knots));
          if (list.empty() || value > list.back().value)
            list.push_back({value, {random(), random(), random()}, random() < 0.25 ? 0.0 : random()});
        }
        for (Knot& knot : list) knot.value *= sign;
        if (sign < 0) std::reverse(list.begin(), list.end());
        const TransferFunction f(list);
        std::vector<Segment> segments;
        for (std::size_t i = 0; i < list.size(); ++i) {
          const auto here = static_cast<float>(list[i].value);
          for (const float step : {-1.0F, 1.0F}) segments.push_back({1, here, here + step});
          // The segment crosses at most 100 knots, because rounding errors grow with the number of pieces.
          const auto there = static_cast<float>(list[std::min(i + 100, list.size() - 1)].value);
          segments.push_back({1, here, there});
          segments.push_back({1, there, here});
        }
        expect_close(segments, in_lanes(f, segments), in_double(f, segments));
      }
  });
}

TEST(LaneIntegrator, AgreesWithTheReference) {
  Random random(103);
  for (const int knots : {2, 6, 20, 100})
    for (const double depth : {1e-6, 0.1, 3.0, 1e3}) {
      const TransferFunction f = random_function(random, knots, 1e6);
      const auto segments = random_segments(random, f, 50, depth);
      std::vector<Light> truth;
      for (const Segment& s : segments) {
        reference::Integral integral(f.knots(), Emission::absorption);
        integral.add(s.length, s.front, s.back, 0, s.length);
        const auto c = integral.color();
        truth.push_back({c[0], c[1], c[2], integral.opacity(), integral.optical_depth()});
      }
      expect_close(segments, in_lanes(f, segments), truth);
    }
}

TEST(LaneIntegrator, AThousandThinSegmentsSumWithoutBias) {
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    const TransferFunction f({{0, {1, 0.5, 0}, 0}, {1 << 20, {0, 0.5, 1}, 1}, {1 << 21, {0.3, 0.3, 0.3}, 0.25}});
    for (const double depth : {1e-30, 1e-9, 1e-6, 1e-3}) {
      Random random(107);
      for (int trial = 0; trial < 50; ++trial) {
        const Segment s{static_cast<float>(depth), whole((1 << 21) * random()), whole((1 << 21) * random())};
        const Light light = in_lanes(f, {s})[0];
        // The true light of the segment. If the segment is thin, its light is kappa c l (1 - q / 2 + ...), and the
        // first term is exact up to 1e-9. For thicker segments, the double integrator is used.
        double r = 0, g = 0, tau = 0;
        if (depth <= 1e-9) {
          const double step = 1 << 20, lo = std::min(s.front, s.back), hi = std::max(s.front, s.back);
          // Simpson's rule is exact for the quadratic kappa c on either side of the middle knot.
          const auto add = [&](double x0, double x1, double share) {
            for (const auto& [u, w] : {std::pair{0.0, 1.0}, std::pair{0.5, 4.0}, std::pair{1.0, 1.0}}) {
              const double x = x0 + (x1 - x0) * u;
              const Knot k = f.evaluate(x);
              r += share * w / 6 * k.extinction * k.color.x;
              g += share * w / 6 * k.extinction * k.color.y;
              tau += share * w / 6 * k.extinction;
            }
          };
          if (hi == lo) {
            add(lo, lo, 1);
          } else {
            if (lo < step) add(lo, std::min(hi, step), (std::min(hi, step) - lo) / (hi - lo));
            if (hi > step) add(std::max(lo, step), hi, (hi - std::max(lo, step)) / (hi - lo));
          }
          r *= s.length, g *= s.length, tau *= s.length;
        } else {
          const Light truth = in_double(f, {s})[0];
          r = truth.r, g = truth.g, tau = truth.optical_depth;
        }
        // The sum in double of 1000 equal segments has the relative error of one segment.
        EXPECT_NEAR(light.g, g, 1e-6 * g) << depth;
        EXPECT_NEAR(light.r, r, 1e-6 * tau) << depth;
        EXPECT_NEAR(light.optical_depth, tau, depth_bound * tau) << depth;
        EXPECT_NEAR(light.alpha, -std::expm1(-tau), 1e-6 * tau) << depth;
      }
    }
  });
}

TEST(LaneIntegrator, OpticalDepthIsRelativelyRightCloseToAClearKnot) {
  // On both sides of a clear knot at 2^29, kappa is proportional to the distance from the knot. The segment may move
  // away from the knot or towards it.
  const double knot = 1 << 29;
  const TransferFunction f({{0, {1, 1, 1}, 1}, {knot, {1, 1, 1}, 0}, {2 * knot, {1, 1, 1}, 1}});
  for (const float distance : {64.0f, 1024.0f, 1048576.0f})
    for (const float sign : {-1.0f, 1.0f}) {
      const auto far_end = static_cast<float>(knot) + sign * distance;
      const auto lights =
          in_lanes(f, {{0.25f, static_cast<float>(knot), far_end}, {0.25f, far_end, static_cast<float>(knot)}});
      const double expected = 0.125 * distance / knot;
      EXPECT_NEAR(lights[0].optical_depth, expected, depth_bound * expected);
      EXPECT_NEAR(lights[1].optical_depth, expected, depth_bound * expected);
    }
}

TEST(LaneIntegrator, CuttingASegmentChangesNothing) {
  Random random(109);
  for (const int knots : {2, 6, 25, 50})
    for (const double depth : {1e-3, 0.3, 4.0}) {
      const TransferFunction f = random_function(random, knots, 1e6);
      for (const Segment& s : random_segments(random, f, 200, depth)) {
        const float middle = whole(s.front + (s.back - s.front) * random());
        const double u = s.front == s.back ? random() : (middle - s.front) / (s.back - s.front);
        const auto l = in_lanes(f, {s,
                                    {static_cast<float>(s.length * u), s.front, middle},
                                    {static_cast<float>(s.length * (1 - u)), middle, s.back}});
        // The bound is that of three results. At a step, the constant segment of length zero may be on either side.
        const double bound = 3 * std::min(light_bound, thin_bound * l[0].optical_depth);
        EXPECT_NEAR(l[0].r, l[1].r + (1 - l[1].alpha) * l[2].r, bound);
        EXPECT_NEAR(l[0].g, l[1].g + (1 - l[1].alpha) * l[2].g, bound);
        EXPECT_NEAR(l[0].alpha, l[1].alpha + (1 - l[1].alpha) * l[2].alpha, bound);
        if (l[0].optical_depth < 19) {
          EXPECT_NEAR(l[0].optical_depth, l[1].optical_depth + l[2].optical_depth,
                      3 * depth_bound * l[0].optical_depth);
        }
      }
    }
}

TEST(LaneIntegrator, ALevelSegmentOnAStepTakesTheUpperKnotAndARayThroughItSeesBothSides) {
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    for (const int more_knots : {0, 10, 40})
      for (const double at : {-7.0, 0.0, 5.0, 16777216.0}) {
        std::vector<Knot> knots{{at - 8, {1, 0, 0}, 1}, {at, {1, 0, 0}, 1}, {at, {0, 1, 0}, 2}};
        for (int i = 0; i <= more_knots; ++i) knots.push_back({at + 8 * (i + 1), {0, 1, 0}, 2});
        const TransferFunction f(knots);
        const auto s = static_cast<float>(at);
        const auto lights =
            in_lanes(f, {{1, s, s}, {2, s + 4, s - 4}, {2, s - 4, s + 4}, {1, s, s - 4}, {1, s, s + 4}});
        EXPECT_EQ(lights[0].r, 0);
        EXPECT_EQ(lights[0].optical_depth, 2);
        EXPECT_NEAR(lights[1].g, 1 - std::exp(-2.0), light_bound);
        EXPECT_NEAR(lights[1].r, std::exp(-2.0) * (1 - std::exp(-1.0)), light_bound);
        EXPECT_NEAR(lights[2].r, 1 - std::exp(-1.0), light_bound);
        EXPECT_NEAR(lights[2].g, std::exp(-1.0) * (1 - std::exp(-2.0)), light_bound);
        EXPECT_EQ(lights[3].g, 0);
        EXPECT_EQ(lights[3].optical_depth, 1);
        EXPECT_EQ(lights[4].r, 0);
        EXPECT_EQ(lights[4].optical_depth, 2);
      }
  });
}

TEST(LaneIntegrator, DataThatEqualAStepsValueStayEqualToItAfterRounding) {
  Random random(113);
  for (int trial = 0; trial < 300; ++trial) {
    const double origin = 10 * random() - 5, unit = std::ldexp(1.0, -28), at = origin + 2 * random() - 1;
    const TransferFunction f({{at, {1, 0, 0}, 1}, {at, {0, 1, 0}, 2}});
    const float s = lane_scalar(at, origin, unit);
    const Light light = in_lanes(LaneTable(f, origin, unit, 1, Emission::absorption), {{1, s, s}})[0];
    EXPECT_EQ(light.r, 0);
    EXPECT_EQ(light.optical_depth, 2);
  }
}

TEST(LaneIntegrator, BitsDependOnNothingButTheSegment) {
  tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    Random random(127);
    for (const int knots : {3, 6, 14, 30, 100})
      for (const Emission emission : {Emission::absorption, Emission::independent}) {
        const TransferFunction f = random_function(random, knots, 1e6);
        const LaneTable table(f, 0, 1, 1, emission);
        std::vector<Segment> segments;
        for (const double depth : {1e-6, 0.1, 1.0, 30.0, 1e5})
          for (const Segment& s : random_segments(random, f, 41, depth)) segments.push_back(s);
        for (int i = 0; i < 20; ++i) segments[static_cast<std::size_t>(random.below(205))].length = 0;
        const auto together = in_lanes(table, segments);
        EXPECT_EQ(in_lanes(table, segments, tests::integrate_masked_lanes), together);
        for (std::size_t i = 0; i < segments.size(); ++i) EXPECT_EQ(in_lanes(table, {segments[i]})[0], together[i]);
        std::vector<Segment> reversed(segments.rbegin(), segments.rend());
        auto lights = in_lanes(table, reversed);
        std::reverse(lights.begin(), lights.end());
        EXPECT_EQ(lights, together);
      }
  });
}

TEST(LaneIntegrator, ZeroLengthAndClearMatterGiveExactZeros) {
  const Light none{0, 0, 0, 0, 0};
  const TransferFunction f({{0, {1, 1, 1}, 3}, {100, {1, 1, 1}, 0}, {200, {1, 1, 1}, 0}, {300, {1, 1, 1}, 1e30}});
  EXPECT_EQ(in_lanes(f, {{0, 1, 299}})[0], none);
  EXPECT_EQ(in_lanes(f, {{0, 299, 299}})[0], none);
  EXPECT_EQ(in_lanes(f, {{7, 100, 200}})[0], none);
  EXPECT_EQ(in_lanes(f, {{7, 150, 110}, {7, 5, 6}})[0], none);
}

TEST(LaneIntegrator, OverflowSaturates) {
  constexpr float largest = std::numeric_limits<float>::max(), smallest = std::numeric_limits<float>::denorm_min();
  const TransferFunction f(
      {{-1000, {1, 0, 0.5}, 1e100}, {0, {0, 0, 1e20}, 0}, {1000, {1, 1e-40, 0}, 1e30}, {1e9, {1, 1, 0}, 0}});
  std::vector<Segment> segments;
  for (const float length : {smallest, 1e-30f, 1.0f, 1e20f, largest})
    for (const float front : {-0x1p30f, -1000.0f, -1.0f, 0.0f, 1.0f, 1000.0f, 0x1p30f})
      for (const float back : {-0x1p30f, -1000.0f, -1.0f, 0.0f, 1.0f, 1000.0f, 0x1p30f})
        segments.push_back({length, front, back});
  for (const Emission emission : {Emission::absorption, Emission::independent})
    for (const Light& light : in_lanes(f, segments, emission)) {
      for (const double x : {light.r, light.g, light.b, light.alpha, light.optical_depth}) {
        EXPECT_TRUE(std::isfinite(x));
        EXPECT_GE(x, -1e-6 * 1e20);  // of the brightest colour
      }
      EXPECT_LE(light.alpha, 1 + 1e-6);
    }
  // An opaque wall has its own colour.
  const Light wall = in_lanes(f, {{largest, -1000, -1000}})[0];
  EXPECT_NEAR(wall.r, 1, light_bound);
  EXPECT_NEAR(wall.alpha, 1, light_bound);
}

TEST(LaneIntegrator, TinyAndHugeScenesAreTheSameScene) {
  const TransferFunction f({{-1, {1, 0.2, 0}, 0.5}, {0.25, {0, 1, 0.3}, 4}, {1, {0, 0, 1}, 1}});
  const std::vector<Segment> segments{{0.5f, -0x1p27f, 0x1p28f}, {1.5f, 0x1p28f, -0x1p28f}, {0.125f, 0, 0}};
  for (const Emission emission : {Emission::absorption, Emission::independent}) {
    const auto expected = in_lanes(LaneTable(f, 0, 0x1p-28, 1, emission), segments);
    for (const int power : {-90, 90}) {
      std::vector<Knot> knots(f.knots().begin(), f.knots().end());
      for (Knot& k : knots) {
        k.extinction = std::ldexp(k.extinction, -power);
        if (emission == Emission::independent) k.color *= std::ldexp(1.0, -power);
      }
      EXPECT_EQ(in_lanes(LaneTable(TransferFunction(knots), 0, 0x1p-28, std::ldexp(1.0, power), emission), segments),
                expected);
    }
  }
}

TEST(LaneIntegrator, KnotsOutOfReachOfTheScalarsKeepTheirSlope) {
  // The data are in [-1, 1], and the knots are at -1000 and 1000. The part of the function that is used is a ramp from
  // 0.999 to 1.001 of the middle value.
  const TransferFunction f({{-1000, {0, 0.5, 0}, 0}, {1000, {1, 0.5, 0}, 2}});
  const LaneTable table(f, 0, 0x1p-30, 1, Emission::absorption);
  const Light light = in_lanes(table, {{0.5f, -0x1p30f, 0x1p30f}})[0];
  const Light truth = in_double(f, {{0.5f, -1, 1}})[0];
  EXPECT_NEAR(light.r, truth.r, light_bound);
  EXPECT_NEAR(light.optical_depth, 0.5, depth_bound);
  const Light end = in_lanes(table, {{0.5f, 0x1p30f, 0x1p30f}})[0];
  EXPECT_NEAR(end.optical_depth, 0.5 * 1.001, depth_bound);
}

}  // namespace
}  // namespace tessera::integrals::lane_integrator_test
