// SPDX-License-Identifier: BSD-3-Clause
// The lattice path's kernels: nanoseconds per cell (set up and rasterized), per segment (scattered to its pixel's
// window) and per segment (sorted, integrated, composited), by the mean size of a cell in pixels and by instruction
// set, on one thread.
//
//   lattice_bench --benchmark_filter=kernels/.*AVX3
//
// Mesh: cube 32; view and transfer function are those of all performance figures; the cell size in pixels determines
// the image size.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <hwy/targets.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "compositor/window_kernel.hpp"
#include "datasets/boxes.hpp"
#include "datasets/transfer_functions.hpp"
#include "frame/mesh/lattice_frame.hpp"
#include "integrals/lane_table.hpp"
#include "projection/depth_order.hpp"
#include "projection/lattice/lattice_rasterizer.hpp"
#include "projection/tile_lists.hpp"
#include "scene/mesh_facts.hpp"

namespace {

using namespace tessera;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

scene::Camera figures_camera() {
  scene::Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.focal_point = {0, 0, 0};
  camera.parallel_scale = 1.8;
  return camera;
}

/// A mesh in a view, its cells in the lists of tiles, in depth order.
struct Frame {
  Frame(const scene::TetMesh& m, int pixels)
      : mesh(&m),
        prepared(m),
        size{pixels, pixels},
        space(figures_camera(), size),
        function(datasets::benchmark_transfer_function()),
        grid{size, 32} {
    vertices.resize(m.positions.size());
    space.project(m.positions, vertices);
    const projection::ProjectedMesh projected{&prepared, vertices, space.near_depth(), space.far_depth(),
                                              space.pixels_per_tangent()};
    lattice = frame::lattice_of(space, scene::bounds(m), scene::scalar_range(m), function, {})->lattice;
    lattice_vertices.resize(vertices.size());
    projection::make_lattice_vertices(vertices, m.scalars, lattice, false, lattice_vertices);
    lists = std::make_unique<projection::TileLists>(projected, grid, function, false);
    lists->fill(0, grid.count());
    projection::DepthOrderScratch scratch;
    for (std::size_t tile = 0; tile < grid.count(); ++tile) {
      const projection::DepthOrder order = projection::order_by_depth(lists->tile(tile), scratch);
      ordered.emplace_back(order.entries.begin(), order.entries.end());
      slack.push_back(order.slack);
      entries += lists->entry_count(tile);
    }
    view = {projected, lattice_vertices, lattice, false};
  }
  const scene::TetMesh* mesh;
  projection::PreparedMesh prepared;
  scene::ImageSize size;
  projection::PixelSpace space;
  scene::TransferFunction function;
  projection::TileGrid grid;
  std::vector<projection::PixelVertex> vertices;
  std::vector<projection::LatticeVertex> lattice_vertices;
  scene::Lattice lattice{};
  projection::LatticeView view{};
  std::unique_ptr<projection::TileLists> lists;
  std::vector<std::vector<projection::TileEntry>> ordered;  ///< per tile
  std::vector<double> slack;
  std::size_t entries = 0;
};

/// Seconds of each stage over all tiles, in the order of a frame: cells are rasterized in batches, their segments are
/// scattered to lists, and the lists are composited when one of them is full.
struct Stages {
  double rasterize = 0, scatter = 0, composite = 0;
  std::uint64_t cells = 0, segments = 0;
};

void run_tiles(Frame& f, Stages& stages) {
  const integrals::LaneTable table(f.function, f.lattice, scene::Emission::absorption);
  const compositor::WindowRules rules{&table, 0};
  const auto state = std::make_unique<compositor::WindowState>();
  projection::SegmentWindows windows;
  projection::SegmentStream stream;
  projection::LatticeScratch scratch;
  projection::RasterCounts counts;
  projection::OpenPixels open;
  scene::StageTimer timer(nullptr);
  for (std::size_t tile = 0; tile < f.grid.count(); ++tile) {
    const std::span<const projection::TileEntry> entries = f.ordered[tile];
    const scene::PixelRect rect = f.grid.rect(tile);
    windows.reset(static_cast<std::size_t>(rect.area()), 32);
    state->start(rect, f.space);
    state->open_pixels(rect, open);
    const auto composite = [&](std::int64_t final_step) {
      const auto start = Clock::now();
      stages.segments += composite_windows(
          rules, windows, final_step,
          final_step < std::numeric_limits<std::int64_t>::max() ? 3 * windows.capacity() / 4 : 1, *state, timer);
      stages.composite += seconds_since(start);
    };
    constexpr std::size_t at_once = 256;  // cells between clock reads
    for (std::size_t from = 0; from < entries.size(); from += at_once) {
      const auto cells = entries.subspan(from, std::min(at_once, entries.size() - from));
      stream.size = 0;
      auto start = Clock::now();
      rasterize_lattice(f.view, {cells, entries.subspan(from + cells.size())}, {rect, open}, scratch, stream, counts);
      stages.rasterize += seconds_since(start);
      const double near = f.lists->depth_origin() + cells.front().near_depth - f.slack[tile] - f.lattice.depth_origin;
      const auto before = static_cast<std::int64_t>(std::floor(near / f.lattice.depth_unit)) - 64;
      for (std::size_t placed = 0; placed < stream.size;) {
        start = Clock::now();
        placed = windows.scatter(stream, placed);
        stages.scatter += seconds_since(start);
        if (placed == stream.size) break;
        composite(before);
        if (windows.count(static_cast<std::size_t>(stream.pixel[placed])) == windows.capacity()) windows.grow();
      }
    }
    composite(std::numeric_limits<std::int64_t>::max());
    stages.cells += entries.size();
  }
}

void choose(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

void kernels(benchmark::State& state, const scene::TetMesh& mesh, int pixels, std::int64_t target) {
  choose(target);
  Frame frame(mesh, pixels);
  Stages least;
  double best = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    Stages stages;
    run_tiles(frame, stages);
    const double all = stages.rasterize + stages.scatter + stages.composite;
    state.SetIterationTime(all);
    if (all < best) best = all, least = stages;
  }
  const auto cells = static_cast<double>(least.cells), segments = static_cast<double>(least.segments);
  state.counters["pixels_a_cell"] = segments / cells;
  state.counters["rasterize_ns_a_cell"] = 1e9 * least.rasterize / cells;
  state.counters["scatter_ns_a_segment"] = 1e9 * least.scatter / segments;
  state.counters["composite_ns_a_segment"] = 1e9 * least.composite / segments;
  state.counters["all_ns_a_segment"] = 1e9 * best / segments;
  choose(0);
}

}  // namespace

int main(int argc, char** argv) {
  const scene::TetMesh mesh = datasets::cube(32);
  for (const std::int64_t target : {std::int64_t{HWY_AVX3}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_SSE4}}) {
    if ((hwy::SupportedTargets() & target) == 0) continue;
    const char* name = hwy::TargetName(target);
    for (const int pixels : {192, 384, 768, 1536})
      benchmark::RegisterBenchmark(fmt::format("kernels/{}/{}", pixels, name).c_str(),
                                   [&mesh, pixels, target](benchmark::State& s) { kernels(s, mesh, pixels, target); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
