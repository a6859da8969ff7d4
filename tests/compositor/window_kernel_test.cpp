// SPDX-License-Identifier: BSD-3-Clause
// composite_windows() under every instruction set, compared with segments integrated and composited in double
// precision.
#include "compositor/window_kernel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <random>
#include <tuple>
#include <utility>

#include "compositor/deep/window_samples.hpp"
#include "compositor/random_rays.hpp"
#include "support/instruction_sets.hpp"

namespace tessera::compositor::window_kernel_test {
namespace {

using tests::RandomRays;
constexpr std::int64_t all = std::numeric_limits<std::int64_t>::max();

/// A float lane's integral has an error of about 2^-22 of a segment's opacity (lane_integrator_test). Along a ray, the
/// sum of the opacities, each times the remaining light, is at most one. The sums themselves are double. Rounding of
/// knots changes a segment by the same amount.
constexpr double lanes_error = 1e-6;

/// Adds the rays in a square's lists, shuffled, in `rounds`: each round adds segments that begin in front of its depth,
/// and some of those behind; then what is final is composited. Returns the number of segments composited.
std::uint64_t composite(RandomRays& rays, const WindowRules& rules, int rounds, std::uint32_t seed,
                        WindowState& state) {
  std::mt19937 random(seed);
  projection::SegmentWindows windows;
  std::size_t most = 1;
  for (const auto& ray : rays.rays) most = std::max(most, ray.size());
  windows.reset(RandomRays::pixels, most, rays.lit);
  state.start(RandomRays::rect, rays.space);
  if (rules.samples != nullptr) rules.samples->start();
  scene::StageTimer timer(nullptr);
  std::vector<std::vector<projection::LatticeSegment>> left = rays.rays;
  std::uint64_t gone = 0, pushed = 0;
  for (int round = 1; round <= rounds; ++round) {
    const std::int64_t final_step = round == rounds ? all : (round * (std::int64_t{1} << 31)) / rounds - (1 << 30);
    for (std::size_t p = 0; p < left.size(); ++p) {
      auto& ray = left[p];
      const auto later = std::partition(ray.begin(), ray.end(),
                                        [&](const auto& s) { return s.front < final_step || random() % 4 == 0; });
      std::shuffle(ray.begin(), later, random);
      for (auto s = ray.begin(); s != later; ++s) {
        EXPECT_TRUE(windows.push(p, *s, rays.lit ? RandomRays::light_of(*s) : projection::SegmentLight{}));
        ++pushed;
      }
      ray.erase(ray.begin(), later);
    }
    gone += composite_windows(rules, windows, final_step, 1, state, timer);
    EXPECT_EQ(gone + windows.total(), pushed);
    for (std::size_t p = 0; p < RandomRays::pixels; ++p)
      for (std::uint32_t k = 0; k < windows.count(p); ++k)
        EXPECT_GE(windows.segments()[k * windows.stride() + p].front, final_step);
  }
  EXPECT_EQ(windows.total(), 0u);
  return gone;
}

struct Table {
  explicit Table(const RandomRays& rays)
      : lanes(rays.function, rays.lattice.scalar_origin, rays.lattice.scalar_unit, rays.lattice.depth_unit,
              scene::Emission::absorption) {}
  integrals::LaneTable lanes;
};

struct Case {
  std::size_t most;
  double extinction;
  bool perspective;
};
/// From rays of one segment to more than any single sorting network handles, from thin matter to some that is opaque at
/// once.
constexpr std::array<Case, 7> cases{{{1, 5, false},
                                     {9, 1, true},
                                     {16, 30, false},
                                     {40, 3, true},
                                     {64, 0.01, false},
                                     {200, 20, false},
                                     {1300, 2, true}}};

/// Checks each case with and without light on the segments.
template <class Check>
void for_each_case(const Check& check) {
  tessera::tests::for_each_instruction_set([&](const char* name) {
    SCOPED_TRACE(name);
    std::uint32_t seed = 0;
    for (const Case& c : cases) {
      SCOPED_TRACE(c.most);
      RandomRays rays(++seed, c.most, c.extinction, c.perspective);
      check(rays, seed);
      SCOPED_TRACE("lit");
      rays.lit = true;
      check(rays, seed);
    }
  });
}

void expect_pixel(const WindowState& state, std::size_t p, const RandomRays::Run& expected, double tolerance) {
  EXPECT_NEAR(state.red[p], expected.red, tolerance) << "pixel " << p;
  EXPECT_NEAR(state.green[p], expected.green, tolerance) << "pixel " << p;
  EXPECT_NEAR(state.blue[p], expected.blue, tolerance) << "pixel " << p;
  EXPECT_NEAR(state.transmittance[p], expected.transmittance, tolerance) << "pixel " << p;
}

TEST(CompositeWindows, PixelsMatchDoublePrecisionUnderEveryInstructionSet) {
  for_each_case([](RandomRays& rays, std::uint32_t seed) {
    const Table table(rays);
    WindowState state;
    EXPECT_EQ(composite(rays, {&table.lanes, 0}, 4, seed, state), rays.total());
    for (std::size_t p = 0; p < RandomRays::pixels; ++p) {
      const auto whole = rays.composited(p, false);
      EXPECT_EQ(state.first_back[p] != WindowState::not_yet, !whole.empty());
      expect_pixel(state, p, whole.empty() ? RandomRays::Run{} : whole[0], lanes_error);
      if (whole.empty()) continue;
      const projection::LatticeSegment first{state.first_front[p], state.first_back[p], state.first_scalar_front[p],
                                             state.first_scalar_back[p]};
      EXPECT_EQ(first_visible_depth(rays.lattice, first, rays.integrator), whole[0].front) << "pixel " << p;
    }
  });
}

TEST(CompositeWindows, APixelsBitsDoNotDependOnTheWindows) {
  for_each_case([](RandomRays& rays, std::uint32_t seed) {
    const Table table(rays);
    for (const double least : {0.0, 0.1}) {
      WindowState at_once, in_rounds;
      const WindowRules rules{&table.lanes, least};
      composite(rays, rules, 1, seed, at_once);
      for (const int rounds : {2, 7}) {
        composite(rays, rules, rounds, seed + 100, in_rounds);
        for (std::size_t p = 0; p < RandomRays::pixels; ++p) {
          ASSERT_EQ(in_rounds.red[p], at_once.red[p]) << "pixel " << p << ", " << rounds << " rounds";
          ASSERT_EQ(in_rounds.transmittance[p], at_once.transmittance[p]) << "pixel " << p;
          ASSERT_EQ(in_rounds.first_back[p], at_once.first_back[p]) << "pixel " << p;
        }
      }
    }
  });
}

// Their promise is tested by tests/frame/deep_test.cpp.
TEST(CompositeWindows, DeepSamplesAddUpToTheRayForAnyWindows) {
  for_each_case([&](RandomRays& rays, std::uint32_t seed) {
    const Table table(rays);
    const auto samples_in = [&](int rounds, WindowState& state) {
      WindowSamples samples(1e-3);
      composite(rays, {.table = &table.lanes, .least_transmittance = 0, .samples = &samples}, rounds, seed + 1, state);
      samples.end_all();
      std::ranges::stable_sort(samples.ended, {}, &WindowSamples::Sample::pixel);
      return samples.ended;
    };
    WindowState state, other;
    const std::vector<WindowSamples::Sample> samples = samples_in(1, state), again = samples_in(5, other);
    ASSERT_EQ(samples.size(), again.size());
    auto next = samples.begin();
    for (std::size_t p = 0; p < RandomRays::pixels; ++p) {
      RandomRays::Run sum{};
      sum.transmittance = 1;
      for (std::int32_t last = std::numeric_limits<std::int32_t>::min(); next != samples.end() && next->pixel == p;
           last = next++->back) {
        EXPECT_GE(next->front, last);
        EXPECT_GE(next->back, next->front);
        const WindowSamples::Sample& same = again[static_cast<std::size_t>(next - samples.begin())];
        EXPECT_EQ(std::tie(next->front, next->back, next->red, next->green, next->blue, next->alpha),
                  std::tie(same.front, same.back, same.red, same.green, same.blue, same.alpha));
        sum.red += sum.transmittance * next->red;
        sum.green += sum.transmittance * next->green;
        sum.blue += sum.transmittance * next->blue;
        sum.transmittance *= 1 - double{next->alpha};
      }
      const auto whole = rays.composited(p, false);
      const RandomRays::Run expected = whole.empty() ? RandomRays::Run{} : whole[0];
      EXPECT_NEAR(sum.red, expected.red, lanes_error) << "pixel " << p;
      EXPECT_NEAR(sum.green, expected.green, lanes_error) << "pixel " << p;
      EXPECT_NEAR(sum.blue, expected.blue, lanes_error) << "pixel " << p;
      EXPECT_NEAR(sum.transmittance, expected.transmittance, lanes_error) << "pixel " << p;
    }
    EXPECT_EQ(next, samples.end());
  });
}

TEST(CompositeWindows, APixelEndsOnlyWhenTooLittleLightRemains) {
  int closed = 0;
  for_each_case([&](RandomRays& rays, std::uint32_t seed) {
    const Table table(rays);
    constexpr double least = 0.05;
    WindowState state;
    composite(rays, {&table.lanes, least}, 3, seed, state);
    for (std::size_t p = 0; p < RandomRays::pixels; ++p) {
      // Where the transmittance is near the limit, lanes may end on the other side of the limit. Elsewhere they end
      // where double precision does.
      const auto ended = rays.composited(p, false, least), before = rays.composited(p, false, least * 1.0001),
                 after = rays.composited(p, false, least * 0.9999);
      if (ended.empty() || before[0].transmittance != after[0].transmittance) continue;
      EXPECT_EQ(state.open[p] == 0, ended[0].transmittance < least) << "pixel " << p;
      expect_pixel(state, p, ended[0], lanes_error);
      closed += state.open[p] == 0;
    }
  });
  EXPECT_GT(closed, 100);
}

TEST(CompositeWindows, RunsMatchDoublePrecisionUnderEveryInstructionSet) {
  for_each_case([](RandomRays& rays, std::uint32_t seed) {
    const Table table(rays);
    WindowState state;
    composite(rays, {&table.lanes, 0, true}, 5, seed, state);
    for (std::size_t p = 0; p < RandomRays::pixels; ++p) state.end_run(p);
    std::vector<std::vector<WindowState::Run>> found(RandomRays::pixels);
    for (const WindowState::Run& run : state.ended) found[run.pixel].push_back(run);
    for (std::size_t p = 0; p < RandomRays::pixels; ++p) {
      const auto expected = rays.composited(p, true);
      ASSERT_EQ(found[p].size(), expected.size()) << "pixel " << p;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        const WindowState::Run& run = found[p][k];  // runs end front to back
        // A run of one lit segment is sent as a run: sending the segment instead would lose the light.
        EXPECT_EQ(run.several, rays.lit || expected[k].showing > 1);
        EXPECT_EQ(first_visible_depth(rays.lattice, run.first, rays.integrator), expected[k].front);
        if (run.several) {
          EXPECT_EQ(rays.lattice.depth(run.back), expected[k].back) << "pixel " << p << ", run " << k;
        }
        EXPECT_NEAR(run.red, expected[k].red, lanes_error);
        EXPECT_NEAR(run.green, expected[k].green, lanes_error);
        EXPECT_NEAR(run.blue, expected[k].blue, lanes_error);
        EXPECT_NEAR(run.opacity, 1 - expected[k].transmittance, lanes_error);
      }
    }
  });
}

TEST(CompositeWindows, RunsEndExactlyWhereSegmentsDoNotTouch) {
  tessera::tests::for_each_instruction_set([](const char* name) {
    SCOPED_TRACE(name);
    RandomRays rays(1, 1, 5, false);
    const Table table(rays);
    const float visible = static_cast<float>(0x1p27);  // above the middle scalar, 0.5, where matter absorbs
    for (const std::int32_t gap : {-touching_steps, 0, touching_steps, touching_steps + 1, 100000}) {
      for (auto& ray : rays.rays) ray = {{0, 1 << 20, visible, visible}, {(1 << 20) + gap, 1 << 21, visible, visible}};
      WindowState state;
      composite(rays, {&table.lanes, 0, true}, 1, 1, state);
      EXPECT_EQ(state.ended.size(), gap > touching_steps ? RandomRays::pixels : 0u) << gap;
    }
  });
}

}  // namespace
}  // namespace tessera::compositor::window_kernel_test
