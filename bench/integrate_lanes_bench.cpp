// SPDX-License-Identifier: BSD-3-Clause
// Nanoseconds per ray segment of the exact integrators: float lanes compared with double, by instruction set, number of
// knots and fraction of segments that cross a knot. Batches stay in the L1 cache; optical depths are 1e-3 to 0.3.
//
//   integrate_lanes_bench --benchmark_filter=AVX3
//
// `smooth`: neighbouring segments have neighbouring scalars, as in an image; `random`: they have not.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "integrals/integrate_lanes.hpp"
#include "integrals/segment_integrator.hpp"

namespace {

using namespace tessera;

constexpr std::size_t batch_size = 512;  // 16 KiB of floats
constexpr double interval = 0x1p16;      // units between knots

scene::TransferFunction function_of(int knots) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<scene::Knot> list;
  for (int i = 0; i < knots; ++i)
    list.push_back({i * interval, {uniform(random), uniform(random), uniform(random)}, 0.1 + uniform(random)});
  return scene::TransferFunction(list);
}

struct Segment {
  float length, front, back;
};

/// A fraction of the segments crosses one knot; the others stay within an interval.
std::vector<Segment> segments_of(int knots, double share, bool smooth) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Segment> list;
  for (std::size_t i = 0; i < batch_size; ++i) {
    const double place = smooth ? double(i) / batch_size : uniform(random);
    const double knot = std::floor(1 + place * (knots - 2));
    double front, back;
    if (uniform(random) < share) {
      front = knot - 0.5 * uniform(random), back = knot + 0.5 * uniform(random);
    } else {
      front = knot + uniform(random), back = knot + uniform(random);
    }
    if (uniform(random) < 0.5) std::swap(front, back);
    list.push_back({static_cast<float>(std::pow(10, -3 + 2.5 * uniform(random))),
                    static_cast<float>(std::floor(front * interval)), static_cast<float>(std::floor(back * interval))});
  }
  return list;
}

void choose(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Times `integrate(batch)` of the segments.
template <class Batch, class Integrate>
void run(benchmark::State& state, const std::vector<Segment>& segments, const Integrate& integrate) {
  Batch batch;
  batch.reserve(batch_size);
  for (const Segment& s : segments) {
    batch.length[batch.size] = s.length;
    batch.scalar_front[batch.size] = s.front;
    batch.scalar_back[batch.size] = s.back;
    ++batch.size;
  }
  for (auto _ : state) {
    integrate(batch);
    benchmark::ClobberMemory();
  }
  const auto count = static_cast<double>(state.iterations()) * batch_size;
  state.counters["ns_a_segment"] =
      benchmark::Counter(count * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  choose(0);
}

void run_float(benchmark::State& state, std::int64_t target, int knots, double share, bool smooth) {
  choose(target);
  const integrals::LaneTable table(function_of(knots), 0, 1, 1, scene::Emission::absorption);
  state.SetLabel(integrals::lane_table_form(table));
  run<integrals::FloatBatch>(state, segments_of(knots, share, smooth),
                             [&](auto& batch) { integrals::integrate_lanes(table, batch); });
}

void run_double(benchmark::State& state, std::int64_t target, int knots, double share, bool smooth) {
  choose(target);
  const integrals::PiecewiseTable table(function_of(knots));
  run<integrals::SegmentBatch>(state, segments_of(knots, share, smooth), [&](auto& batch) {
    integrals::integrate_exact(table, scene::Emission::absorption, batch);
  });
}

}  // namespace

int main(int argc, char** argv) {
  for (std::int64_t left = hwy::SupportedTargets() & HWY_TARGETS, target = 0; left != 0; left &= ~target) {
    target = left & -left;
    if (target == HWY_EMU128 || target == HWY_SCALAR) continue;
    for (const int knots : {6, 14, 30, 256})
      for (const bool smooth : {true, false}) {
        if (!smooth && knots < 256) continue;
        for (const double share : {0.0, 0.05, 0.2, 1.0}) {
          const auto name = [&](const char* lanes) {
            return fmt::format("{}/{}/{}_knots{}/{:.0f}%_cross", lanes, hwy::TargetName(target), knots,
                               knots < 256 ? ""
                               : smooth    ? "/smooth"
                                           : "/random",
                               100 * share);
          };
          benchmark::RegisterBenchmark(name("float").c_str(), run_float, target, knots, share, smooth);
          benchmark::RegisterBenchmark(name("double").c_str(), run_double, target, knots, share, smooth);
        }
      }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
