// SPDX-License-Identifier: BSD-3-Clause
// The ray caster of regular grids: time of a 1024x1024 image of 256^3 samples in memory, and CPU nanoseconds per
// visited voxel, over two threads; for each method, requested accuracy and sample type, shaded or not, and with an
// opaque and a sparse transfer function, which show the effect of early termination and empty space skipping.
//
//   cast_volume_bench [--benchmark_filter=auto]
//
// View and transfer function are those of all performance figures (bench/camera.txt, bench/transfer_function.txt).
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <map>
#include <memory>
#include <vector>

#include "cpu_time.hpp"
#include "datasets/volumes.hpp"
#include "volume/render.hpp"

namespace {

using namespace tessera;

std::unique_ptr<scene::SampleSource> ripples(int bits) {
  const auto made = datasets::generate_volume("ripples", {{"n", 256}, {"bits", bits}});
  const auto count = static_cast<std::size_t>(made->geometry().all_samples().count());
  const auto kept = [&](auto kind) -> std::unique_ptr<scene::SampleSource> {
    std::vector<decltype(kind)> samples(count);
    made->read(made->geometry().all_samples(), std::span(samples));
    return scene::MemorySource::of(made->grid(), std::move(samples));
  };
  return bits == 8 ? kept(std::uint8_t{}) : kept(float{});
}

/// Returns the function of bench/transfer_function.txt, an opaque variant of it (`opaque`), or a function that is
/// transparent below 0.85 of the range (`sparse`).
scene::TransferFunction function(const std::string& kind, double scale) {
  std::vector<scene::Knot> knots = {{0.0, {0.0, 0.0, 0.3}, 0.0}, {0.3, {0.1, 0.3, 0.9}, 0.4},
                                    {0.5, {0.2, 0.9, 0.3}, 0.0}, {0.7, {0.9, 0.8, 0.1}, 3.0},
                                    {0.8, {1.0, 0.3, 0.0}, 0.2}, {1.0, {1.0, 1.0, 1.0}, 8.0}};
  if (kind == "opaque")
    for (scene::Knot& knot : knots) knot.extinction *= 30;
  if (kind == "sparse") knots = {{0.85, {1, 0.6, 0.2}, 0}, {0.95, {1, 1, 1}, 10}, {1.0, {1, 1, 1}, 10}};
  for (scene::Knot& knot : knots) knot.value *= scale;
  return scene::TransferFunction(knots);
}

void cast(benchmark::State& state, volume::RenderSettings settings, int bits, const std::string& kind) {
  static std::map<int, std::unique_ptr<scene::SampleSource>> sources;
  auto& source = sources[bits];
  if (!source) source = ripples(bits);
  settings.threads = 2;
  volume::Renderer renderer(*source, settings);
  scene::Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.parallel_scale = 1.8;
  const scene::TransferFunction f = function(kind, bits == 8 ? 255 : 1);
  const volume::RenderStatistics statistics = renderer.render(camera, {1024, 1024}, f).statistics;
  const double before = bench::process_seconds();
  for (auto _ : state) benchmark::DoNotOptimize(renderer.render(camera, {1024, 1024}, f));
  const double each = (bench::process_seconds() - before) / static_cast<double>(state.iterations());
  state.counters["cpu_ms"] = 1e3 * each;
  state.counters["ns_voxel"] = 1e9 * each / static_cast<double>(statistics.voxels_visited);
  state.counters["pieces_voxel"] =
      static_cast<double>(statistics.samples) / static_cast<double>(statistics.voxels_visited);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const auto add = [](const std::string& name, const volume::RenderSettings& settings, int bits = 32,
                      const char* kind = "usual") {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { cast(state, settings, bits, kind); })
        ->Unit(benchmark::kMillisecond)
        ->UseRealTime();
  };
  volume::RenderSettings automatic, exact, sampled, shaded;
  exact.integrator.kind = IntegratorKind::exact;
  sampled.integrator.kind = IntegratorKind::sampled;
  shaded.grid.shading.emplace();
  for (const double accuracy : {1e-5, 1e-4, 1e-3}) {
    automatic.integrator.accuracy = accuracy;
    add(fmt::format("auto/{:g}", accuracy), automatic);
  }
  automatic.integrator.accuracy = 1e-4;
  add("auto/0.0001/8bit", automatic, 8);
  add("auto/0.0001/opaque", automatic, 32, "opaque");
  add("auto/0.0001/sparse", automatic, 32, "sparse");
  add("auto/0.0001/shaded", shaded);
  add("exact", exact);
  add("sampled/0.5", sampled);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
