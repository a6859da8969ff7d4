// SPDX-License-Identifier: BSD-3-Clause
// The work of a frame before its first ray segment: project vertices, cull and count, fill, order. CPU nanoseconds over
// all threads, per vertex (transform), tet (cull, fill) or list entry (order); by threads, by instruction set, and with
// the transfer function that shows 5 % of the cells. For cull and fill also the amount read: 64 threads on fewer cores
// do the same work as on 64.
//
//   tile_lists_bench [MESH_FILE] --benchmark_filter=cull
//
// Meshes: cube 64 (TESSERA_BENCH_CUBE=n for another) as generated and with its cells and vertices in random order, or a
// file's. View and transfer function are those of all performance figures; tiles of 32 pixels.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "cpu_time.hpp"
#include "datasets/boxes.hpp"
#include "datasets/transfer_functions.hpp"
#include "io/formats/identify.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "projection/depth_order.hpp"
#include "projection/tile_lists.hpp"

namespace {

using namespace tessera;

/// The same mesh with neighbours far apart in memory.
scene::TetMesh shuffled(const scene::TetMesh& mesh) {
  std::mt19937 random(1);
  std::vector<std::uint32_t> vertex(mesh.positions.size());
  std::iota(vertex.begin(), vertex.end(), 0u);
  std::shuffle(vertex.begin(), vertex.end(), random);
  scene::TetMesh out = mesh;
  for (std::size_t v = 0; v < vertex.size(); ++v) {
    out.positions[vertex[v]] = mesh.positions[v];
    out.scalars[vertex[v]] = mesh.scalars[v];
  }
  for (scene::Tet& tet : out.tets)
    for (std::uint32_t& v : tet) v = vertex[v];
  std::shuffle(out.tets.begin(), out.tets.end(), random);
  return out;
}

/// Shows only the highest scalars, in 5 % of the cells.
scene::TransferFunction five_percent(const scene::TetMesh& mesh) {
  std::vector<double> highest;
  for (const scene::Tet& t : mesh.tets)
    highest.push_back(std::max({mesh.scalars[t[0]], mesh.scalars[t[1]], mesh.scalars[t[2]], mesh.scalars[t[3]]}));
  const auto at = highest.begin() + static_cast<std::ptrdiff_t>(highest.size() * 95 / 100);
  std::nth_element(highest.begin(), at, highest.end());
  return scene::TransferFunction({{*at, {1, 1, 1}, 0}, {*at + 1, {1, 1, 1}, 10}});
}

struct Stage {
  Stage(const scene::TetMesh& m)
      : mesh(m), prepared(mesh), space(camera(m), {1024, 1024}), grid{{1024, 1024}, 32}, vertices(m.positions.size()) {
    space.project(mesh.positions, vertices);
    projected = {&prepared, vertices, space.near_depth(), space.far_depth(), space.pixels_per_tangent()};
    figures = datasets::benchmark_transfer_function();
    few = five_percent(mesh);
  }
  static scene::Camera camera(const scene::TetMesh& mesh) {
    const scene::Box box = scene::bounds(mesh);
    const glm::dvec3 centre = 0.5 * (box.low + box.high);
    const double half = 0.5 * std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
    scene::Camera camera;
    camera.position = centre + half * glm::dvec3(3.1, 2.3, 4.2);
    camera.focal_point = centre;
    camera.parallel_scale = 1.8 * half;
    return camera;
  }
  scene::TetMesh mesh;
  projection::PreparedMesh prepared;
  projection::PixelSpace space;
  projection::TileGrid grid;
  std::vector<projection::PixelVertex> vertices;
  projection::ProjectedMesh projected;
  scene::TransferFunction figures, few;
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

/// Reports the reads per tet between two counts; `serial`: those while all threads but one wait.
void show_reads(benchmark::State& state, const Stage& s, const projection::TileListReads& before,
                const projection::TileListReads& after) {
  const auto tets = static_cast<double>(s.mesh.tets.size());
  state.counters["cells_read_a_tet"] = static_cast<double>(after.cells - before.cells) / tets;
  state.counters["counters_a_tet"] = static_cast<double>(after.counters - before.counters) / tets;
  state.counters["serial_a_tet"] = static_cast<double>(after.serial_counters - before.serial_counters) / tets;
}

void cull(benchmark::State& state, Stage& s, const scene::TransferFunction& function) {
  projection::TileListReads reads;
  measure(state, "cpu_ns_a_tet", [&] {
    projection::TileLists lists(s.projected, s.grid, function, false, {.buffers = &s.buffers});
    reads = lists.reads();
    return s.mesh.tets.size();
  });
  show_reads(state, s, {}, reads);
}

void fill(benchmark::State& state, Stage& s, const scene::TransferFunction& function) {
  // The arena that culls determines the number of runs.
  tbb::task_arena arena(static_cast<int>(state.range(0)));
  std::optional<projection::TileLists> made;
  arena.execute(
      [&] { made.emplace(s.projected, s.grid, function, false, projection::TileListSettings{.buffers = &s.buffers}); });
  projection::TileLists& lists = *made;
  projection::TileListReads before, after;
  measure(state, "cpu_ns_a_tet", [&] {
    before = lists.reads();
    lists.fill(0, s.grid.count());
    after = lists.reads();
    return s.mesh.tets.size();
  });
  show_reads(state, s, before, after);
  state.counters["bytes_a_tet"] = static_cast<double>(lists.bytes()) / static_cast<double>(s.mesh.tets.size());
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
  each("cull", [](benchmark::State& state, Stage& s) { cull(state, s, s.figures); });
  each("cull_5_percent", [](benchmark::State& state, Stage& s) { cull(state, s, s.few); });
  each("fill", [](benchmark::State& state, Stage& s) { fill(state, s, s.figures); });
  each("fill_5_percent", [](benchmark::State& state, Stage& s) { fill(state, s, s.few); });
  each("order", order);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc > 1) {
    add(argv[1], std::make_shared<Stage>(io::read_mesh(io::identify(argv[1])).mesh));
  } else {
    const char* side = std::getenv("TESSERA_BENCH_CUBE");
    const int n = side != nullptr ? std::atoi(side) : 64;
    const scene::TetMesh mesh = datasets::cube(n);
    add(fmt::format("cube_{}", n), std::make_shared<Stage>(mesh));
    add(fmt::format("cube_{}_shuffled", n), std::make_shared<Stage>(shuffled(mesh)));
  }
  benchmark::RunSpecifiedBenchmarks();
}
