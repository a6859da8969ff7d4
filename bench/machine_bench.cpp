// SPDX-License-Identifier: BSD-3-Clause
// The machine's limits, for figures in percent of it: fused multiply-adds of single precision (GFLOP/s) and the STREAM
// triad a = b + s * c (GB/s, three arrays larger than any cache, including the read before each write), on one and two
// threads, by instruction set.
//
//   machine_bench
#include <benchmark/benchmark.h>

#include <thread>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_bench.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tessera::bench {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// `rounds` multiply-adds on each of twelve vectors: enough to hide four cycles of latency on two ports. Returns the
/// number of floating point operations.
double multiply_add(std::size_t rounds, float* sink) {
  const hn::ScalableTag<float> d;
  using V = hn::Vec<decltype(d)>;
  const V factor = hn::Set(d, 0.999f), term = hn::Set(d, 1e-3f);
  // All different; otherwise a compiler computes one for all.
  const auto start = [&](int i) HWY_ATTR { return hn::Set(d, static_cast<float>(i)); };
  V a = start(1), b = start(2), c = start(3), e = start(4), f = start(5), g = start(6), h = start(7), i = start(8),
    j = start(9), k = start(10), l = start(11), m = start(12);
  for (std::size_t r = 0; r < rounds; ++r) {
    a = hn::MulAdd(a, factor, term), b = hn::MulAdd(b, factor, term), c = hn::MulAdd(c, factor, term);
    e = hn::MulAdd(e, factor, term), f = hn::MulAdd(f, factor, term), g = hn::MulAdd(g, factor, term);
    h = hn::MulAdd(h, factor, term), i = hn::MulAdd(i, factor, term), j = hn::MulAdd(j, factor, term);
    k = hn::MulAdd(k, factor, term), l = hn::MulAdd(l, factor, term), m = hn::MulAdd(m, factor, term);
  }
  const V sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)),
                        hn::Add(hn::Add(hn::Add(f, g), hn::Add(h, i)), hn::Add(hn::Add(j, k), hn::Add(l, m))));
  *sink = hn::GetLane(hn::SumOfLanes(d, sum));
  return 24.0 * static_cast<double>(rounds * hn::Lanes(d));
}

void triad(float* a, const float* b, const float* c, float s, std::size_t n) {
  const hn::ScalableTag<float> d;
  const auto factor = hn::Set(d, s);
  for (std::size_t i = 0; i < n; i += hn::Lanes(d))
    hn::StoreU(hn::MulAdd(factor, hn::LoadU(d, c + i), hn::LoadU(d, b + i)), d, a + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <string>

namespace tessera::bench {
HWY_EXPORT(multiply_add);
HWY_EXPORT(triad);
namespace {

/// Runs `work(thread)` on several threads at once and waits for all.
template <class Work>
void on_threads(int threads, Work work) {
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(work, t);
  work(0);
  for (std::thread& other : others) other.join();
}

void flops(benchmark::State& state) {
  const auto threads = static_cast<int>(state.range(0));
  std::vector<float> sink(static_cast<std::size_t>(threads));
  double done = 0;
  for (auto _ : state) {
    std::vector<double> each(static_cast<std::size_t>(threads));
    on_threads(threads, [&](int t) {
      const auto at = static_cast<std::size_t>(t);
      each[at] = HWY_DYNAMIC_DISPATCH(multiply_add)(std::size_t{1} << 24, &sink[at]);
    });
    for (const double one : each) done += one;
  }
  benchmark::DoNotOptimize(sink.data());
  state.counters["GFLOP_s"] = benchmark::Counter(done * 1e-9, benchmark::Counter::kIsRate);
}

void bandwidth(benchmark::State& state) {
  const auto threads = static_cast<int>(state.range(0));
  const std::size_t n = std::size_t{1} << 25;  // 128 MiB per array
  std::vector<float> a(n), b(n, 1), c(n, 2);
  for (auto _ : state) {
    on_threads(threads, [&](int t) {
      const std::size_t part = n / static_cast<std::size_t>(threads), from = part * static_cast<std::size_t>(t);
      HWY_DYNAMIC_DISPATCH(triad)(a.data() + from, b.data() + from, c.data() + from, 0.5f, part);
    });
    benchmark::ClobberMemory();
  }
  // Two arrays read, and one written, which is also read first.
  state.counters["GB_s"] = benchmark::Counter(static_cast<double>(state.iterations()) * 16e-9 * static_cast<double>(n),
                                              benchmark::Counter::kIsRate);
}

}  // namespace
}  // namespace tessera::bench

int main(int argc, char** argv) {
  using namespace tessera::bench;
  for (const std::int64_t target : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSE4}}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    const auto add = [&](const std::string& what, auto work) {
      benchmark::RegisterBenchmark((what + "/" + hwy::TargetName(target)).c_str(),
                                   [=](benchmark::State& state) {
                                     hwy::SetSupportedTargetsForTest(target);
                                     hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                     work(state);
                                     hwy::SetSupportedTargetsForTest(0);
                                     hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                   })
          ->ArgName("threads")
          ->Arg(1)
          ->Arg(2)
          ->UseRealTime()
          ->Unit(benchmark::kMillisecond);
    };
    add("multiply_add", flops);
    add("triad", bandwidth);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
#endif  // HWY_ONCE
