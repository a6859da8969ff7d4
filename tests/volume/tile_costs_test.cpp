// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/tile_costs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include "volume/split/balanced_split.hpp"
#include "volume/split/image_split.hpp"

namespace tessera::volume::tile_costs_test {
namespace {

constexpr int tile = 32;

scene::Camera straight() {
  scene::Camera camera;
  camera.position = {0, 0, 5};
  camera.parallel_scale = 2;
  return camera;
}

/// Every tile of an image, with its time.
template <class Microseconds>
std::vector<TileTime> tiles_of(scene::ImageSize size, const Microseconds& microseconds) {
  std::vector<TileTime> times;
  for (int y = 0; y < size.height; y += tile)
    for (int x = 0; x < size.width; x += tile)
      times.push_back({{x, y, std::min(x + tile, size.width), std::min(y + tile, size.height)},
                       static_cast<float>(microseconds(x, y))});
  return times;
}

/// A hill away from the middle.
double hill(double x, double y) {
  const double u = (x - 200) / 120, v = (y - 150) / 90;
  return 20 + 2000 * std::exp(-u * u - v * v);
}

TEST(TileCosts, ReportedCostsAreTheMeasuredTimes) {
  const scene::ImageSize size{203, 101};
  std::mt19937 random(5);
  const auto times = tiles_of(size, [&](int, int) { return 1 + random() % 5000; });
  TileCosts costs(straight(), size, glm::dvec3(0));
  costs.learn(times);
  costs.sum();
  double all = 0;
  for (const auto& [pixels, microseconds] : times) {
    all += 1e3 * static_cast<double>(microseconds);
    // The sum has about a hundred squares, each in float.
    EXPECT_NEAR(costs.of(pixels), 1e3 * static_cast<double>(microseconds), 1e-4 * 5e6);
  }
  EXPECT_NEAR(costs.of({0, 0, size.width, size.height}), all, 1e-5 * all);
}

TEST(TileCosts, PartsOfATileCostMoreTogetherAndPredictTheWhole) {
  const scene::ImageSize size{64, 64};
  TileCosts costs(straight(), size, glm::dvec3(0));
  costs.learn(tiles_of(size, [](int, int) { return 1000; }));
  costs.sum();
  const scene::PixelRect left{0, 0, 8, 32}, right{8, 0, 32, 32}, whole{0, 0, 32, 32};
  EXPECT_GT(costs.of(left), 0.25 * costs.of(whole));
  EXPECT_LT(costs.of(left), 0.5 * costs.of(whole));
  EXPECT_GT(costs.of(left) + costs.of(right), 1.05 * costs.of(whole));
  const double before = costs.of(whole);
  costs.learn(std::vector<TileTime>{{left, static_cast<float>(1e-3 * costs.of(left))},
                                    {right, static_cast<float>(1e-3 * costs.of(right))}});
  costs.sum();
  EXPECT_NEAR(costs.of(whole), before, 1e-4 * before);
}

TEST(TileCosts, FollowThePicturesOfThePlaneThroughTheMiddle) {
  const scene::ImageSize size{512, 384};
  TileCosts costs(straight(), size, glm::dvec3(0));
  costs.learn(tiles_of(size, hill));
  costs.sum();
  const scene::PixelRect there{160, 96, 288, 224};
  const double before = costs.of(there);

  // 384 pixels are 4 units high. If the camera moves 64 pixels to the right, the image moves to the left.
  TileCosts panned = costs;
  scene::Camera camera = straight();
  camera.position.x += 64 * 4.0 / 384, camera.focal_point.x = camera.position.x;
  panned.turn_to(camera);
  panned.sum();
  EXPECT_NEAR(panned.of({96, 96, 224, 224}), before, 0.01 * before);
  panned.turn_to(straight());
  panned.sum();
  EXPECT_NEAR(panned.of(there), before, 0.01 * before);

  // Twice as near, in both projections: four times the pixels, each with the same cost as before.
  for (const auto kind : {scene::ProjectionKind::orthographic, scene::ProjectionKind::perspective}) {
    scene::Camera from = straight(), to = straight();
    from.projection = to.projection = kind;
    to.parallel_scale = 1;
    if (kind == scene::ProjectionKind::perspective) to.position.z = 2.5;
    TileCosts zoomed(from, size, glm::dvec3(0));
    zoomed.learn(tiles_of(size, hill));
    zoomed.turn_to(to);
    zoomed.sum();
    // Pixel (256 + u, 192 + v) goes to (256 + 2 u, 192 + 2 v).
    EXPECT_NEAR(zoomed.of({64, 0, 320, 256}), 4 * before, 0.05 * 4 * before);
  }
}

/// Every pixel is in one process's parts, which share no tile.
void expect_whole(const ImageSplit& split, scene::ImageSize size, int processes) {
  ASSERT_EQ(split.processes(), processes);
  std::vector<int> owners(static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height), 0);
  for (int p = 0; p < processes; ++p) {
    std::set<std::pair<int, int>> tiles;
    for (const scene::PixelRect& r : split.parts(p)) {
      for (int y = r.y0 / tile; y * tile < r.y1 && !r.empty(); ++y)
        for (int x = r.x0 / tile; x * tile < r.x1; ++x) EXPECT_TRUE(tiles.insert({x, y}).second) << p;
      for (int y = r.y0; y < r.y1; ++y)
        for (int x = r.x0; x < r.x1; ++x) ++owners[static_cast<std::size_t>(y * size.width + x)];
    }
  }
  EXPECT_TRUE(std::all_of(owners.begin(), owners.end(), [](int n) { return n == 1; }));
}

std::vector<double> loads_of(const ImageSplit& split, const TileCosts& costs, const std::vector<double>& beside) {
  std::vector<double> loads = beside;
  for (int p = 0; p < split.processes(); ++p)
    for (const scene::PixelRect& part : split.parts(p)) loads[static_cast<std::size_t>(p)] += costs.of(part);
  return loads;
}

TEST(BalancedSplit, SharesWorkIncludingOtherWorkOfProcesses) {
  const scene::ImageSize size{512, 384};
  TileCosts costs(straight(), size, glm::dvec3(0));
  for (int n = 0; n < 3; ++n) costs.learn(tiles_of(size, hill));
  costs.sum();
  const double all = costs.of({0, 0, size.width, size.height});
  for (int processes = 1; processes <= 12; ++processes) {
    std::vector<double> beside(static_cast<std::size_t>(processes), 0.01 * all / processes);
    beside[0] = 0.3 * all / processes;
    const ImageSplit split = balanced_split(costs, beside);
    expect_whole(split, size, processes);
    const std::vector<double> loads = loads_of(split, costs, beside);
    const double mean = std::accumulate(loads.begin(), loads.end(), 0.0) / processes;
    // The edge of a row is on every fourth line of pixels. Four lines have up to 2.5 % of the hill's cost, which is
    // 30 % of the share of one of twelve processes. Four processes share this error.
    EXPECT_LT(*std::max_element(loads.begin(), loads.end()), 1.075 * mean) << processes;
    EXPECT_GT(*std::min_element(loads.begin(), loads.end()), 0.9 * mean) << processes;
  }
}

TEST(BalancedSplit, IsWholeForAnyCostsSizesAndNumbers) {
  std::mt19937 random(11);
  for (int n = 0; n < 60; ++n) {
    const auto up_to = [&](int most) { return 1 + static_cast<int>(random() % static_cast<unsigned>(most)); };
    const scene::ImageSize size{up_to(300), up_to(300)};
    const int processes = up_to(16);
    TileCosts costs(straight(), size, glm::dvec3(0));
    costs.learn(tiles_of(size, [&](int, int) { return random() % 3 == 0 ? 0 : random() % 1000; }));
    costs.sum();
    std::vector<double> beside;
    for (int p = 0; p < processes; ++p) beside.push_back(static_cast<double>(random() % 100000));
    expect_whole(balanced_split(costs, beside), size, processes);
  }
}

}  // namespace
}  // namespace tessera::volume::tile_costs_test
