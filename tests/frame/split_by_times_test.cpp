// Splits by what pictures before took: rank 0, which gathers them, gets less of the tiles.
#include "frame/split_by_times.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

namespace tessera::frame {
namespace {

constexpr int side = 64;
const scene::Box box{glm::dvec3(-1), glm::dvec3(1)};
const VolumeJob job = [] {
  scene::Camera camera;
  camera.position = {0, 0, 9};
  camera.focal_point = {0, 0, 0};
  camera.view_up = {0, 1, 0};
  return VolumeJob{camera, {side, side}};
}();

/// Two ranks, of which each has the left or right half, 50 ms of work each, and so many milliseconds of other things.
std::vector<CastTimes> times(double beside_first, double beside_second) {
  constexpr double half_ms = 50;
  std::vector<CastTimes> ranks(2);
  for (std::uint64_t rank = 0; rank < 2; ++rank) {
    const int x0 = rank == 0 ? 0 : side / 2;
    const scene::PixelRect pixels{x0, 0, x0 + side / 2, side};
    const double beside_ms = rank == 0 ? beside_first : beside_second;
    ranks[rank] = {true, rank + 1, 1e-3 * (half_ms + beside_ms), {{pixels, static_cast<float>(1e3 * half_ms)}}};
  }
  return ranks;
}

/// The weights when all that is known of what ranks do beside their tiles is one picture.
std::vector<double> weights_of(double beside_first, double beside_second) {
  SplitByTimes splits;
  splits.learn(job, box, times(beside_first, beside_second));
  return splits.weights();
}

void expect_same(const std::vector<double>& ours, const std::vector<double>& theirs) {
  ASSERT_EQ(ours.size(), theirs.size());
  for (std::size_t rank = 0; rank < ours.size(); ++rank) EXPECT_NEAR(ours[rank], theirs[rank], 1e-9) << rank;
}

TEST(SplitByTimes, ARankGetsLessByWhatItDoesBesideItsTiles) {
  // 100 ms of tiles and 24 of other things are 62 for each: 42 and 58 of tiles.
  const std::vector<double> weights = weights_of(20, 4);
  ASSERT_EQ(weights.size(), 2u);
  EXPECT_NEAR(weights[0] / weights[1], 42.0 / 58.0, 1e-9);
}

TEST(SplitByTimes, TheFirstPicturesDoNotCountOnceOthersAreThere) {
  SplitByTimes splits;
  splits.learn(job, box, times(10, 10));  // nothing is gathered yet
  splits.learn(job, box, times(20, 10));
  expect_same(splits.weights(), weights_of(20, 10));
  splits.learn(job, box, times(24, 4));
  expect_same(splits.weights(), weights_of(24, 4));
}

TEST(SplitByTimes, OnePictureOfManyChangesLittle) {
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
  EXPECT_NEAR(pixels(0), 0.42, 0.02);  // to a step of the rectangles' edges
}

}  // namespace
}  // namespace tessera::frame
