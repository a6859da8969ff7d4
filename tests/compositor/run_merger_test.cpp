// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "compositor/tile_merger.hpp"
#include "integrals/lane_table.hpp"
#include "projection/lattice/segment_windows.hpp"

namespace tessera::compositor::run_merger_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr scene::PixelRect tile{0, 0, 16, 8};
constexpr int pixels = 16 * 8, projectors = 3;

struct Scene {
  static scene::Camera camera() {
    scene::Camera camera;
    camera.position = {0, 0, 5};
    camera.parallel_scale = 1;
    return camera;
  }
  [[nodiscard]] std::unique_ptr<TileMerger> merger() const {
    MergeContext context{&space, &integrator, function.max_color(), 2, 0.5f, scene::Emission::absorption, 1 << 28};
    context.lattice = &lattice;
    context.table = &table;
    context.on_lattice = true;
    return make_tile_merger(exchange::RecordKind::lattice_runs, context, tile);
  }

  scene::TransferFunction function{{{0, {0.1, 0, 0.3}, 0.2}, {1, {1, 1, 1}, 2}}};
  projection::PixelSpace space{camera(), {16, 8}};
  integrals::SegmentIntegrator integrator{function, {scene::IntegratorKind::exact}, scene::Emission::absorption};
  scene::Lattice lattice{.depth_origin = 3, .depth_unit = 0x1p-28, .scalar_origin = 0.5, .scalar_unit = 0x1p-30};
  integrals::LaneTable table{function, lattice.scalar_origin, lattice.scalar_unit, lattice.depth_unit,
                             scene::Emission::absorption};
};

struct PixelRuns {
  std::vector<exchange::LatticeRun> runs;
  std::vector<projection::LatticeSegment> segments;
};
/// By projector and pixel.
using Runs = std::array<std::array<PixelRuns, pixels>, projectors>;

/// Runs of random pixels that do not overlap: each run has a separate depth range.
Runs random_runs(std::mt19937& random, bool segments) {
  Runs made;
  const auto uniform = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
  for (int p = 0; p < pixels; ++p) {
    std::array<int, 9> places{0, 1, 2, 3, 4, 5, 6, 7, 8};
    std::shuffle(places.begin(), places.end(), random);
    const auto count = std::uniform_int_distribution<std::size_t>(0, places.size())(random);
    for (std::size_t i = 0; i < count; ++i) {
      PixelRuns& to = made[random() % projectors][static_cast<std::size_t>(p)];
      const std::int32_t front = (places[i] - 4) * 10'000'000, back = front + 9'000'000;
      if (segments && random() % 3 == 0)
        to.segments.push_back({front, back, 1e9f * (uniform() - 0.5f), 1e9f * (uniform() - 0.5f)});
      else
        to.runs.push_back({front, back, uniform() / 4, uniform() / 4, uniform() / 4, uniform() / 2});
    }
  }
  return made;
}

exchange::TilePart part_of(const Runs& runs, int projector, bool ascending) {
  exchange::TilePart part{.tile = 7,
                          .kind = exchange::RecordKind::lattice_runs,
                          .last = true,
                          .final_depth = infinity,
                          .projector = projector,
                          .start_depth = -infinity};
  exchange::Bytes bytes;
  for (std::uint32_t k = 0; k < pixels; ++k) {
    const std::uint32_t p = ascending ? k : pixels - 1 - k;
    const PixelRuns& of = runs[static_cast<std::size_t>(projector)][p];
    if (of.runs.empty() && of.segments.empty()) continue;
    exchange::append(bytes, exchange::RunsHeader{p, static_cast<std::uint16_t>(of.runs.size()),
                                                 static_cast<std::uint16_t>(of.segments.size())});
    exchange::append_values(bytes, of.runs);
    exchange::append_values(bytes, of.segments);
    part.fragments += of.runs.size() + of.segments.size();
    part.segments |= !of.segments.empty();
  }
  part.ascending = ascending;
  part.records = std::move(bytes);
  return part;
}

/// `ascending`: which projectors' parts are sorted. `cut`: a depth up to which everything is merged first.
scene::Image merged(const Scene& scene, const Runs& runs, std::array<bool, projectors> ascending,
                    double cut = -infinity) {
  const auto merger = scene.merger();
  for (int p = 0; p < projectors; ++p) merger->add(part_of(runs, p, ascending[static_cast<std::size_t>(p)]));
  if (std::isfinite(cut)) merger->advance(cut);
  merger->advance(infinity);
  return merger->finish().image;
}

TEST(RunMerger, AscendingPartsSideBySideMatchUnorderedParts) {
  const Scene scene;
  std::mt19937 random(11);
  for (int trial = 0; trial < 50; ++trial) {
    const Runs runs = random_runs(random, trial % 2 == 1);
    const scene::Image none = merged(scene, runs, {false, false, false});
    for (const auto& ascending : {std::array{true, true, true}, std::array{true, false, true}})
      for (const double cut : {-infinity, 2.99, 3.0, 3.05}) {
        const scene::Image image = merged(scene, runs, ascending, cut);
        ASSERT_EQ(image.rgba, none.rgba) << "trial " << trial << " to " << cut;
        ASSERT_EQ(image.depth, none.depth) << "trial " << trial << " to " << cut;
      }
  }
}

TEST(RunMerger, RunsCompositeFrontToBack) {
  const Scene scene;
  std::mt19937 random(12);
  const Runs runs = random_runs(random, false);
  const scene::Image image = merged(scene, runs, {true, true, true});
  for (std::size_t p = 0; p < pixels; ++p) {
    std::vector<exchange::LatticeRun> all;
    for (const auto& of_projector : runs)
      all.insert(all.end(), of_projector[p].runs.begin(), of_projector[p].runs.end());
    std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.front < b.front; });
    double red = 0, through = 1;
    for (const exchange::LatticeRun& run : all) red += through * run.red, through *= 1 - double{run.opacity};
    EXPECT_NEAR(image.rgba[4 * p], red, 1e-6) << p;  // roundings of a float below 1
    EXPECT_NEAR(image.rgba[4 * p + 3], 1 - through, 1e-6) << p;
    const double first = all.empty() ? infinity : scene.lattice.depth(all.front().front);
    EXPECT_EQ(image.depth[p], static_cast<float>(first)) << p;
  }
}

TEST(RunMerger, RefusesMislabelledParts) {
  const Scene scene;
  const exchange::LatticeRun run{0, 1000, 0.1f, 0.1f, 0.1f, 0.1f};
  const projection::LatticeSegment segment{0, 1000, 0, 0};
  using Headers = std::vector<exchange::RunsHeader>;
  const auto refused = [&](const Headers& headers, bool segments, std::size_t cut_off) {
    exchange::Bytes bytes;
    for (const exchange::RunsHeader& header : headers) {
      exchange::append(bytes, header);
      for (int i = 0; i < header.runs; ++i) exchange::append(bytes, run);
      for (int i = 0; i < header.segments; ++i) exchange::append(bytes, segment);
    }
    bytes.resize(bytes.size() - cut_off);
    exchange::TilePart part{.tile = 7, .kind = exchange::RecordKind::lattice_runs, .last = true, .fragments = 3};
    part.records = std::move(bytes);
    part.ascending = true;
    part.segments = segments;
    const auto merger = scene.merger();
    try {
      merger->add(part);
      merger->advance(infinity);
      return false;
    } catch (const scene::Error& error) {
      EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
      return true;
    }
  };
  EXPECT_FALSE(refused({{3, 1, 0}, {4, 1, 0}}, false, 0));
  EXPECT_FALSE(refused({{3, 1, 1}, {4, 0, 1}}, true, 0));
  EXPECT_TRUE(refused({{4, 1, 0}, {3, 1, 0}}, false, 0)) << "descends";
  EXPECT_TRUE(refused({{4, 1, 0}, {4, 1, 0}}, false, 0)) << "twice";
  EXPECT_TRUE(refused({{3, 1, 0}, {pixels, 1, 0}}, false, 0)) << "beyond the tile";
  EXPECT_TRUE(refused({{0xffffffff, 1, 0}}, false, 0)) << "beyond all tiles";
  EXPECT_TRUE(refused({{3, 1, 1}}, false, 0)) << "a segment that it did not announce";
  const std::size_t whole = 2 * (sizeof(exchange::RunsHeader) + sizeof run) + sizeof segment;
  for (std::size_t cut = 1; cut < whole; ++cut) {
    if (cut == sizeof(exchange::RunsHeader) + sizeof run) continue;  // only the first record is complete
    EXPECT_TRUE(refused({{3, 1, 1}, {4, 1, 0}}, true, cut)) << cut << " bytes cut off";
  }
}

}  // namespace
}  // namespace tessera::compositor::run_merger_test
