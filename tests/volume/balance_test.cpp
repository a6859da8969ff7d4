// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <random>

#include "scene/error.hpp"
#include "volume/render.hpp"
#include "volume/split/cost_map.hpp"
#include "volume/split/image_split.hpp"
#include "volume/split/learned_work.hpp"

namespace tessera::volume::balance_test {
namespace {

constexpr scene::ImageSize image{256, 256};

/// Two blobs of different size in a box, so that work is not uniform over the image.
std::unique_ptr<scene::MemorySource> blobs(std::int64_t n) {
  scene::Grid grid;
  grid.geometry.points = {n, n, n};
  grid.geometry.origin = glm::dvec3(-1);
  grid.geometry.spacing = glm::dvec3(2.0 / static_cast<double>(n - 1));
  std::vector<float> values;
  for (std::int64_t k = 0; k < n; ++k)
    for (std::int64_t j = 0; j < n; ++j)
      for (std::int64_t i = 0; i < n; ++i) {
        const glm::dvec3 p = 2.0 * glm::dvec3(double(i), double(j), double(k)) / double(n - 1) - 1.0;
        const auto ball = [&](const glm::dvec3& c, double r) { return std::exp(-glm::dot(p - c, p - c) / (r * r)); };
        values.push_back(static_cast<float>(ball({0.4, 0.3, 0.2}, 0.35) + 0.8 * ball({-0.5, -0.4, -0.3}, 0.25)));
      }
  return scene::MemorySource::of(grid, std::move(values));
}

scene::TransferFunction haze() { return scene::TransferFunction({{0.2, {1, 1, 1}, 0}, {0.6, {1, 0.5, 0.2}, 0.4}}); }

/// A turn around an oblique axis, and a zoom in.
std::vector<scene::Camera> animation() {
  std::vector<scene::Camera> cameras;
  scene::Camera camera;
  camera.position = {2.5, 1.8, 3.3};
  camera.parallel_scale = 1.5;
  for (int frame = 0; frame < 6; ++frame) cameras.push_back(scene::orbit(camera, frame / 6.0));
  camera.projection = scene::ProjectionKind::perspective;
  for (const double angle : {45.0, 25.0, 12.0}) {
    camera.view_angle = angle;
    cameras.push_back(camera);
  }
  return cameras;
}

/// Total length of all rays of each process in visited cells, from the accurate map at full resolution.
std::vector<double> work_of(const CostMap& full, const ImageSplit& split) {
  const SummedArea table(full);
  std::vector<double> work;
  for (int process = 0; process < split.processes(); ++process) {
    const scene::PixelRect r = split.region(process);
    work.push_back(static_cast<double>(table.sum(r.x1, r.y1) + table.sum(r.x0, r.y0) - table.sum(r.x0, r.y1) -
                                       table.sum(r.x1, r.y0)));
  }
  return work;
}

double deviation(const std::vector<double>& samples) {
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  const double mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  return (*most - *least) / mean;
}

void expect_tiling(const ImageSplit& split, int processes, scene::ImageSize size) {
  ASSERT_EQ(split.processes(), processes);
  std::vector<int> owners(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  for (int process = 0; process < processes; ++process) {
    const scene::PixelRect r = split.region(process);
    for (int y = r.y0; y < r.y1; ++y)
      for (int x = r.x0; x < r.x1; ++x)
        ++owners[static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x)];
  }
  EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), static_cast<std::ptrdiff_t>(owners.size()));
}

TEST(Balance, VisitedCostIsTheLengthOfEachRayInTheCells) {
  scene::GridGeometry geometry;
  geometry.points = {33, 33, 33};
  geometry.origin = {-1, -1, -1};
  geometry.spacing = glm::dvec3(1 / 16.0);
  scene::Camera camera;
  camera.position = {0, 0, 5};
  // Cells of 8^3 voxels: the middle 2 x 2 x 2 of 4 x 4 x 4, and one in front of them.
  std::vector<std::uint8_t> visible(64);
  for (const int c : {1, 2})
    for (const int b : {1, 2})
      for (const int a : {1, 2}) visible[static_cast<std::size_t>(a + 4 * (b + 4 * c))] = 1;
  visible[1 + 4 * 1] = 1;
  const CostMap map = cost_map(camera, {32, 32}, geometry, {{4, 4, 4}, visible}, {}, {CostMethod::visited, 1, true});
  // Rays go along z, with one pixel per voxel. They cross 16 voxels of the first box and 8 of the second, which is at
  // low y, in the image's lower part. Pixels within two pixels of a cell are in a packet that may meet it.
  const auto covers = [](int v, int low, int high) { return v >= low - 2 && v < high + 2; };
  const auto sure = [](int v) { return v % 8 >= 2 && v % 8 < 6; };
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool first = covers(x, 8, 24) && covers(y, 8, 24), second = covers(x, 8, 16) && covers(y, 16, 24);
      const std::uint32_t cost = map.cost[static_cast<std::size_t>(y * 32 + x)];
      EXPECT_LE(cost, 64u * ((first ? 16u : 0u) + (second ? 8u : 0u))) << x << ' ' << y;
      if (sure(x) && sure(y)) {
        EXPECT_EQ(cost, 64u * ((first ? 16u : 0u) + (second ? 8u : 0u))) << x << ' ' << y;
      }
    }
}

TEST(Balance, MethodsThatGoByBricksKeepEachBricksTotal) {
  scene::GridGeometry geometry;
  geometry.points = {65, 65, 65};
  geometry.origin = {-1, -1, -1};
  geometry.spacing = glm::dvec3(1 / 32.0);
  std::vector<CostBox> bricks;
  for (const int c : {3, 4})
    for (const int b : {2, 3, 4})
      for (const int a : {2, 3, 4}) {
        const glm::dvec3 low(8 * a, 8 * b, 8 * c);
        bricks.push_back({low, low + 8.0});
      }
  for (const scene::Camera& camera : animation()) {
    if (camera.projection == scene::ProjectionKind::perspective) continue;
    // Length times area is volume: voxels crossed along a unit of depth, times the box's volume in pixels.
    const glm::dvec3 slope = glm::abs(scene::view_basis(camera).forward) * 32.0;
    const double pixel = 2 * camera.parallel_scale / image.height;
    const double expected = 64 * (slope.x + slope.y + slope.z) * (24 * 24 * 16) / (32.0 * 32 * 32) / (pixel * pixel);
    for (const CostMethod method : {CostMethod::accurate, CostMethod::backface, CostMethod::splatting}) {
      const CostMap map = cost_map(camera, image, geometry, {}, bricks, {method, 1, true});
      // Sampled at the centres of pixels: outlines of sixty pixels are accurate to a few percent.
      EXPECT_NEAR(std::accumulate(map.cost.begin(), map.cost.end(), 0.0), expected, 0.05 * expected);
    }
  }
}

TEST(Balance, SplitsTileThePictureInProportionToTheWeights) {
  std::mt19937 random(4);
  std::uniform_int_distribution<std::uint32_t> cost(0, 1000);
  CostMap map;
  map.resolution = 0.5;
  map.size = {60, 41};
  map.region = {0, 0, 60, 41};
  for (int i = 0; i < 60 * 41; ++i) map.cost.push_back(cost(random) * (i % 60 < 20 ? 1 : 9));
  const scene::ImageSize size{120, 82};
  for (const int processes : {1, 2, 3, 5, 6, 7, 16, 40}) {
    std::vector<double> weights;
    for (int p = 0; p < processes; ++p) weights.push_back(1 + p % 3);
    const ImageSplit found = split(map, size, weights);
    expect_tiling(found, processes, size);
    if (processes > 7) continue;
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    const double total = std::accumulate(map.cost.begin(), map.cost.end(), 0.0);
    for (int p = 0; p < processes; ++p) {
      const scene::PixelRect r = found.region(p);
      double mine = 0;
      for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x)
          mine += map.cost[static_cast<std::size_t>(y / 2) * 60 + static_cast<std::size_t>(x / 2)] / 4.0;
      // Split lines are between whole pixels, so each side may be off by half a line.
      EXPECT_NEAR(mine / total, weights[static_cast<std::size_t>(p)] / all, 0.02) << p << " of " << processes;
    }
  }
}

TEST(Balance, TheTwoStageSearchInPartsFindsTheSplitOfOneProcess) {
  const auto source = blobs(48);
  RenderSettings settings;
  settings.threads = 1;
  const Renderer renderer(*source, settings);
  for (const scene::Camera& camera : animation()) {
    const CostMap whole = renderer.cost_map(camera, image, haze(), {CostMethod::visited, 0.5});
    const ImageSplit expected = split(whole, image, std::vector<double>(6, 1.0), region_grain);
    // As in the first frame: each process computes the cost of an equal tile of the map.
    const scene::PixelRect area = footprint(camera, image, source->geometry());
    const ImageSplit tiles = even_split(6, whole.size, {area.x0 / 2, area.y0 / 2, area.x1 / 2, area.y1 / 2});
    expect_tiling(tiles, 6, whole.size);
    std::vector<CostMap> maps;
    std::vector<RowSums> rows;
    for (int p = 0; p < 6; ++p) {
      maps.push_back(renderer.cost_map(camera, image, haze(), {.resolution = 0.5, .region = tiles.region(p)}));
      rows.push_back(SplitSearch::row_sums(maps.back(), SummedArea(maps.back())));
    }
    SplitSearch search(image, 0.5, whole.size, std::vector<double>(6, 1.0), region_grain);
    search.find_rows(rows);
    std::vector<ColumnSums> columns;
    for (const CostMap& map : maps)
      columns.push_back(SplitSearch::column_sums(map, SummedArea(map), search.map_rows()));
    const ImageSplit found = search.find_columns(columns);
    EXPECT_EQ(found.rows, expected.rows);
    EXPECT_EQ(found.columns, expected.columns);
  }
}

TEST(Balance, CellsThatNoRayMetTakeCostsOfTheirNeighbours) {
  const scene::GridIndex voxels{64, 64, 64};
  WorkTally tally(voxels);
  ASSERT_EQ(tally.cells().count(), 512u);
  // Cells have two samples per slab in the low half along i, and zero in the other half. One cell is left out.
  const std::size_t unseen = tally.cells().number(20, 30, 30);
  for (std::int64_t k = 0; k < 64; k += 8)
    for (std::int64_t j = 0; j < 64; j += 8)
      for (std::int64_t i = 0; i < 64; i += 8) {
        const std::size_t cell = tally.cells().number(i, j, k);
        if (cell != unseen) tally.add(cell, i < 32 ? 2000 : 0, 1000, i < 32 ? 500.0f : 0.0f);
      }
  WorkRates rates(voxels);
  rates.learn(tally.take());
  EXPECT_NEAR(rates.samples(tally.cells().number(4, 4, 4)), 2, 0.05);
  EXPECT_NEAR(rates.samples(tally.cells().number(60, 4, 4)), 0, 0.05);
  EXPECT_NEAR(rates.depth(tally.cells().number(4, 4, 4)), 0.5, 0.02);
  EXPECT_NEAR(rates.samples(unseen), 2, 0.1);
  EXPECT_NEAR(rates.depth(unseen), 0.5, 0.05);
  for (const std::uint64_t word : tally.take()) EXPECT_EQ(word, 0u);
  // A volume of any size has few cells; places outside count for the nearest cell.
  const WorkCells large({2048, 2048, 2048});
  EXPECT_EQ(large.count(), std::size_t{1} << 15);
  EXPECT_EQ(large.number(-5, 3000, 0), large.number(0, 2047, 0));
}

TEST(Balance, MapsOfQuarterResolutionGiveProcessesTheSameWork) {
  const auto source = blobs(96);
  RenderSettings settings;
  settings.threads = 2;
  const Renderer renderer(*source, settings);
  double visited = 0, accurate = 0, backface = 0, splatting = 0, even = 0;
  const std::vector<scene::Camera> cameras = animation();
  for (const scene::Camera& camera : cameras) {
    const CostMap full = renderer.cost_map(camera, image, haze(), {CostMethod::visited, 1});
    const auto of = [&](CostMethod method) {
      const CostMap map = renderer.cost_map(camera, image, haze(), {method, 0.5});
      return deviation(work_of(full, split(map, image, std::vector<double>(6, 1.0))));
    };
    visited += of(CostMethod::visited);
    accurate += of(CostMethod::accurate);
    backface += of(CostMethod::backface);
    splatting += of(CostMethod::splatting);
    even += deviation(work_of(full, even_split(6, image, footprint(camera, image, source->geometry()))));
  }
  const auto frames = static_cast<double>(cameras.size());
  // A line of 256 pixels is a percent of the work of one of six processes, and each side of a rectangle may be off by a
  // line.
  EXPECT_LE(visited / frames, 0.05);
  EXPECT_LT(accurate, even / 2);
  EXPECT_LT(backface, even / 2);
  EXPECT_LT(splatting, even / 2);
}

}  // namespace
}  // namespace tessera::volume::balance_test
