// SPDX-License-Identifier: BSD-3-Clause
// The work of a frame before its first ray segment: project vertices, cull and count, fill, order. CPU nanoseconds over
// all threads, per vertex (transform), tet (cull, fill) or list entry (order); by threads and by instruction set.
//
//   tile_lists_bench --benchmark_filter=cull
//
// Mesh: cube 64; view and transfer function are those of all performance figures; tiles of 32 pixels.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "cpu_time.hpp"
#include "datasets/boxes.hpp"
#include "datasets/transfer_functions.hpp"
#include "projection/depth_order.hpp"
#include "projection/tile_lists.hpp"

namespace {

using namespace tessera;

struct Stage {
  Stage(const scene::TetMesh& m)
      : mesh(m), prepared(mesh), space(camera(), {1024, 1024}), grid{{1024, 1024}, 32}, vertices(m.positions.size()) {
    space.project(mesh.positions, vertices);
    projected = {&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
    figures = datasets::benchmark_transfer_function();
  }
  static scene::Camera camera() {
    scene::Camera camera;
    camera.position = {3.1, 2.3, 4.2};
    camera.parallel_scale = 1.8;
    return camera;
  }
  scene::TetMesh mesh;
  projection::PreparedMesh prepared;
  projection::PixelSpace space;
  projection::TileGrid grid;
  std::vector<projection::PixelVertex> vertices;
  projection::ProjectedMesh projected;
  scene::TransferFunction figures;
  projection::TileListBuffers buffers;
};

/// Runs `work` in an arena with as many threads as the benchmark's argument; `count` items per run.
template <class Work>
void measure(benchmark::State& state, const char* each, Work work) {
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  double cpu = 0, count = 0;
  for (auto _ : state) {
    const double start = bench::process_seconds();
    count += static_cast<double>(arena.execute(work));
    cpu += bench::process_seconds() - start;
  }
  state.counters[each] = 1e9 * cpu / count;
}

void transform(benchmark::State& state, Stage& s) {
  measure(state, "cpu_ns_a_vertex", [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, s.vertices.size(), 4096), [&](const auto& range) {
      const std::size_t n = range.end() - range.begin();
      s.space.project(std::span(s.mesh.positions).subspan(range.begin(), n),
                      std::span(s.vertices).subspan(range.begin(), n));
    });
    return s.vertices.size();
  });
}

/// Reports the reads per tet. The reads depend on the number of threads, but not on the number of cores. `serial`:
/// reads during which all threads but one wait.
void show_reads(benchmark::State& state, const Stage& s, const projection::TileListReads& before,
                const projection::TileListReads& after) {
  const auto tets = static_cast<double>(s.mesh.tets.size());
  state.counters["cells_read_a_tet"] = static_cast<double>(after.cells - before.cells) / tets;
  state.counters["counters_a_tet"] = static_cast<double>(after.counters - before.counters) / tets;
  state.counters["serial_a_tet"] = static_cast<double>(after.serial_counters - before.serial_counters) / tets;
}

void cull(benchmark::State& state, Stage& s) {
  projection::TileListReads reads;
  measure(state, "cpu_ns_a_tet", [&] {
    projection::TileLists lists(s.projected, s.grid, s.figures, false, {.buffers = &s.buffers});
    reads = lists.reads();
    return s.mesh.tets.size();
  });
  show_reads(state, s, {}, reads);
}

void fill(benchmark::State& state, Stage& s) {
  // The arena that culls determines the number of runs.
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  std::optional<projection::TileLists> lists;
  arena.execute([&] {
    lists.emplace(s.projected, s.grid, s.figures, false, projection::TileListSettings{.buffers = &s.buffers});
  });
  projection::TileListReads before;
  measure(state, "cpu_ns_a_tet", [&] {
    before = lists->reads();
    lists->fill(0, s.grid.count());
    return s.mesh.tets.size();
  });
  show_reads(state, s, before, lists->reads());
}

void order(benchmark::State& state, Stage& s) {
  projection::TileLists lists(s.projected, s.grid, s.figures, false, {.buffers = &s.buffers});
  lists.fill(0, s.grid.count());
  std::vector<projection::TileEntry> entries;
  std::vector<std::size_t> starts{0};
  for (std::size_t tile = 0; tile < s.grid.count(); ++tile) {
    entries.insert(entries.end(), lists.tile(tile).begin(), lists.tile(tile).end());
    starts.push_back(entries.size());
  }
  std::vector<projection::TileEntry> ordered(entries.size());
  tbb::enumerable_thread_specific<projection::DepthOrderScratch> scratch;
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  double cpu = 0, count = 0;
  for (auto _ : state) {
    std::copy(entries.begin(), entries.end(), ordered.begin());
    const double start = bench::process_seconds();
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, s.grid.count(), [&](std::size_t tile) {
        projection::order_by_depth(std::span(ordered).subspan(starts[tile], starts[tile + 1] - starts[tile]),
                                   scratch.local());
      });
    });
    cpu += bench::process_seconds() - start;
    count += static_cast<double>(entries.size());
  }
  state.counters["cpu_ns_an_entry"] = 1e9 * cpu / count;
}

void add(const std::string& name, const std::shared_ptr<Stage>& stage) {
  const auto each = [&](const std::string& what, auto work) {
    for (const std::int64_t target : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSE4}}) {
      if ((hwy::SupportedTargets() & target) == 0) continue;
      auto* b = benchmark::RegisterBenchmark(fmt::format("{}/{}/{}", what, name, hwy::TargetName(target)).c_str(),
                                             [=](benchmark::State& state) {
                                               hwy::SetSupportedTargetsForTest(target);
                                               hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                               work(state, *stage);
                                               hwy::SetSupportedTargetsForTest(0);
                                               hwy::GetChosenTarget().Update(hwy::SupportedTargets());
                                             });
      b->Unit(benchmark::kMillisecond)->UseRealTime()->ArgName("threads")->Arg(1);
      if (target == HWY_AVX3) b->Arg(2)->Arg(64);
    }
  };
  each("transform", transform);
  each("cull", cull);
  each("fill", fill);
  each("order", order);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  add("cube_64", std::make_shared<Stage>(datasets::cube(64)));
  benchmark::RunSpecifiedBenchmarks();
}
