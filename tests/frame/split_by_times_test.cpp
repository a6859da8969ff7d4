// SPDX-License-Identifier: BSD-3-Clause
// Splits based on the times of previous images: rank 0, which gathers them, gets fewer of the tiles.
#include "frame/grid/split_by_times.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "volume/tile_rays.hpp"

namespace tessera::frame::split_by_times_test {
namespace {

constexpr int side = 64, tile = volume::TileRays::side;
const scene::Box box{glm::dvec3(-1), glm::dvec3(1)};
const VolumeJob job = [] {
  scene::Camera camera;
  camera.position = {0, 0, 9};
  camera.focal_point = {0, 0, 0};
  camera.view_up = {0, 1, 0};
  return VolumeJob{camera, {side, side}};
}();

/// The times of two ranks. Each rank has the left or right half of the image, with 50 ms of tile work, and the given
/// milliseconds of other work.
std::vector<CastTimes> times(double first_other_work, double second_other_work) {
  constexpr double half_ms = 50;
  std::vector<CastTimes> ranks(2);
  for (std::uint64_t rank = 0; rank < 2; ++rank) {
    const int x0 = rank == 0 ? 0 : side / 2;
    const scene::PixelRect pixels{x0, 0, x0 + side / 2, side};
    const double other_work_ms = rank == 0 ? first_other_work : second_other_work;
    ranks[rank] = {true, rank + 1, 1e-3 * (half_ms + other_work_ms), {{pixels, static_cast<float>(1e3 * half_ms)}}};
  }
  return ranks;
}

/// The weights when the ranks' other work is known from one image only.
std::vector<double> weights_of(double first_other_work, double second_other_work) {
  SplitByTimes splits;
  splits.learn(job, box, times(first_other_work, second_other_work));
  return splits.weights();
}

void expect_same(const std::vector<double>& ours, const std::vector<double>& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t rank = 0; rank < ours.size(); ++rank) EXPECT_NEAR(ours[rank], theirs[rank], 1e-9) << rank;
}

TEST(SplitByTimes, ARankGetsLessForItsOtherWork) {
  // 100 ms of tile work and 24 ms of other work are 62 ms for each rank. So the ranks get 42 and 58 ms of tile work.
  const std::vector<double> weights = weights_of(20, 4);
  ASSERT_EQ(weights.size(), 2u);
  EXPECT_NEAR(weights[0] / weights[1], 42.0 / 58.0, 1e-9);
}

TEST(SplitByTimes, TheFirstFramesDoNotCountOnceThereAreOthers) {
  SplitByTimes splits;
  splits.learn(job, box, times(10, 10));  // nothing is gathered yet
  splits.learn(job, box, times(20, 10));
  expect_same(splits.weights(), weights_of(20, 10));
  splits.learn(job, box, times(24, 4));
  expect_same(splits.weights(), weights_of(24, 4));
}

TEST(SplitByTimes, OneFrameOfManyChangesLittle) {
  SplitByTimes splits;
  for (int picture = 0; picture < 20; ++picture) splits.learn(job, box, times(20, 4));
  splits.learn(job, box, times(40, 4));
  expect_same(splits.weights(), weights_of(24, 4));
}

TEST(SplitByTimes, ASplitGivesRanksTheSameTime) {
  SplitByTimes splits;
  splits.learn(job, box, times(20, 4));
  const auto split = splits.find(job, box);
  ASSERT_TRUE(split);
  ASSERT_EQ(split->processes(), 2);
  const auto pixels = [&](int rank) {
    double sum = 0;
    for (const scene::PixelRect& part : split->parts(rank))
      sum += static_cast<double>(part.x1 - part.x0) * (part.y1 - part.y0);
    return sum / (side * side);
  };
  EXPECT_NEAR(pixels(0) + pixels(1), 1, 1e-9);
  EXPECT_NEAR(pixels(0), 0.42, 0.02);  // up to a step of the rectangles' edges
}

// The prediction moves with the box as the eye moves past it; the tile times here stay fixed in the image. So each step
// has the same prediction error. The times of one image do not reveal this error; after many images, the split is even.
TEST(SplitByTimes, ErrorsThatRepeatFromFrameToFrameAreLearned) {
  constexpr scene::ImageSize size{512, 512};
  constexpr int ranks = 4;
  const auto took = [](const scene::PixelRect& r) {  // microseconds: increasing to the right
    return 0.02 * (r.y1 - r.y0) * (r.x1 - r.x0) * (0.2 + 0.5 * (r.x0 + r.x1) / size.width);
  };
  SplitByTimes splits;
  std::vector<double> deviations;
  std::vector<std::vector<scene::PixelRect>> of_ranks(ranks);
  for (int rank = 0; rank < ranks; ++rank)
    of_ranks[static_cast<std::size_t>(rank)] = {
        {rank * size.width / ranks, 0, (rank + 1) * size.width / ranks, size.height}};
  for (int picture = 0; picture < 24; ++picture) {
    scene::Camera camera = job.camera;
    camera.position.x = camera.focal_point.x = 0.2 * picture;
    const VolumeJob moved{camera, size};
    const auto split = splits.find(moved, box);
    ASSERT_EQ(split.has_value(), picture > 0);
    if (split)
      for (int rank = 0; rank < ranks; ++rank) of_ranks[static_cast<std::size_t>(rank)] = split->parts(rank);
    std::vector<CastTimes> measured(ranks);
    std::vector<double> all;
    for (std::size_t rank = 0; rank < ranks; ++rank) {
      double own = 0;
      measured[rank].process = rank + 1;
      for (const scene::PixelRect& part : of_ranks[rank])
        for (int y = part.y0 / tile * tile; y < part.y1; y += tile)
          for (int x = part.x0 / tile * tile; x < part.x1; x += tile) {
            const scene::PixelRect r = scene::common(part, {x, y, x + tile, y + tile});
            measured[rank].tiles.push_back({r, static_cast<float>(took(r))});
            own += took(r);
          }
      measured[rank].cpu_seconds = 1e-6 * own;
      all.push_back(own);
    }
    const auto [least, most] = std::minmax_element(all.begin(), all.end());
    deviations.push_back((*most - *least) * ranks / std::accumulate(all.begin(), all.end(), 0.0));
    splits.learn(moved, box, measured);
  }
  EXPECT_GT(deviations[1], 0.1) << "nothing is missed";
  for (std::size_t late = 16; late < deviations.size(); ++late) EXPECT_LT(deviations[late], 0.03) << late;
}

}  // namespace
}  // namespace tessera::frame::split_by_times_test
