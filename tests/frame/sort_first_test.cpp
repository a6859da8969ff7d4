// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "exchange/loopback_transport.hpp"
#include "frame/render_sort_first.hpp"
#include "frame/small_grid.hpp"
#include "scene/error.hpp"
#include "support/some_cases.hpp"

namespace tessera::frame::sort_first_test {
namespace {

/// A bright ball off the centre of a hazy box.
std::unique_ptr<scene::MemorySource> ball() {
  return small_grid(40, [](const glm::dvec3& place) {
    const glm::dvec3 p = place - glm::dvec3(0.4, 0.3, 0.2);
    return std::exp(-4 * (p.x * p.x + p.y * p.y + p.z * p.z));
  });
}

scene::TransferFunction haze() { return scene::TransferFunction({{0.1, {0.2, 0.4, 1}, 0}, {0.9, {1, 0.5, 0.2}, 5}}); }

std::vector<VolumeJob> orbit(int frames) {
  std::vector<VolumeJob> jobs;
  scene::Camera camera;
  camera.position = {2.5, 1.8, 3.3};
  camera.parallel_scale = 1.6;
  for (int i = 0; i < frames; ++i) jobs.push_back({scene::orbit(camera, i / 8.0), {101, 67}});
  camera.projection = scene::ProjectionKind::perspective;
  camera.position = {0.1, 0.2, 0.6};  // inside
  camera.view_angle = 80;
  jobs.push_back({camera, {101, 67}});
  return jobs;
}

std::vector<std::uint64_t> samples_of(const FinishedVolumeFrame& frame) {
  std::vector<std::uint64_t> samples;
  for (const GridCounters& rank : frame.ranks) samples.push_back(rank.samples);
  return samples;
}

std::vector<FinishedVolumeFrame> render(int ranks, const Settings& settings, const std::vector<VolumeJob>& jobs) {
  const auto source = ball();
  std::vector<FinishedVolumeFrame> frames;
  exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
    volume::RenderSettings render;
    render.threads = 1;
    volume::Renderer renderer(*source, render);
    render_sort_first(transport, settings, jobs, haze(), renderer,
                      [&](FinishedVolumeFrame frame) { frames.push_back(std::move(frame)); });
  });
  return frames;
}

TEST(SortFirst, AnyNumberOfProcessesAndAnyBalanceGivesTheBitsOfOne) {
  const std::vector<VolumeJob> jobs = orbit(3);
  const auto source = ball();
  volume::RenderSettings alone;
  alone.threads = 2;
  volume::Renderer renderer(*source, alone);
  std::vector<scene::Image> expected;
  for (const VolumeJob& job : jobs) expected.push_back(renderer.render(job.camera, job.size, haze()).image);
  test::SomeCases some(5);
  for (const int ranks : {1, 2, 3, 6})
    for (const Balance balance : {Balance::learned, Balance::accurate, Balance::backface, Balance::splatting,
                                  Balance::previous, Balance::even}) {
      if (!some.next()) continue;
      Settings settings;
      settings.ranks.balance = balance;
      settings.ranks.balance_resolution = ranks == 3 ? 1.0 : 0.5;
      settings.ranks.balance_measured = ranks == 6;
      const auto frames = render(ranks, settings, jobs);
      ASSERT_EQ(frames.size(), jobs.size());
      for (std::size_t i = 0; i < jobs.size(); ++i) {
        EXPECT_EQ(frames[i].frame, i);
        EXPECT_EQ(frames[i].image.rgba, expected[i].rgba) << ranks << " ranks, frame " << i;
        EXPECT_EQ(frames[i].image.depth, expected[i].depth);
        const std::vector<std::uint64_t> samples = samples_of(frames[i]);
        EXPECT_EQ(samples.size(), static_cast<std::size_t>(ranks));
        EXPECT_EQ(std::accumulate(samples.begin(), samples.end(), std::uint64_t{0}), frames[i].statistics.samples);
        ASSERT_EQ(frames[i].ranks.size(), static_cast<std::size_t>(ranks));
        GridCounters together;
        for (const GridCounters& rank : frames[i].ranks) together += rank;
        for (const GridCounter& counter : grid_counters)
          EXPECT_EQ(together.*counter.member, frames[i].statistics.*counter.member) << counter.name;
      }
    }
}

TEST(SortFirst, EveryCounterIsThatOfAllRanksTogether) {
  // There is no pilot pass, because it would load bricks into memory.
  Settings settings;
  settings.ranks.balance = Balance::even;
  const std::vector<VolumeJob> jobs{orbit(1)[0]};
  const auto frames = render(3, settings, jobs);
  ASSERT_EQ(frames.size(), 1u);
  const auto source = ball();
  volume::RenderSettings alone;
  alone.threads = 1;
  GridCounters together;
  for (int rank = 0; rank < 3; ++rank) {
    volume::Renderer renderer(*source, alone);
    const volume::RenderStatistics part =
        renderer.render(jobs[0].camera, jobs[0].size, haze(), {.regions = {frames[0].split.region(rank)}}).statistics;
    EXPECT_GT(part.samples, 0u) << rank;
    together += part;
  }
  for (const GridCounter& counter : grid_counters) {
    if (counter.name.ends_with("_us")) continue;
    EXPECT_EQ(frames[0].statistics.*counter.member, together.*counter.member) << counter.name;
  }
}

/// (largest - least) / mean.
double deviation(const std::vector<std::uint64_t>& samples) {
  const auto [least, most] = std::minmax_element(samples.begin(), samples.end());
  return static_cast<double>(*most - *least) * static_cast<double>(samples.size()) /
         static_cast<double>(std::accumulate(samples.begin(), samples.end(), std::uint64_t{0}));
}

TEST(SortFirst, LearnedBalanceSharesCountedSamplesInTheFirstFrameAndWhereRaysEndEarly) {
  // Each view is rendered separately: nothing is known about the view or about rank 0's time for gathering. The ball is
  // opaque.
  std::vector<VolumeJob> jobs;
  scene::Camera camera;
  camera.position = {2.5, 1.8, 3.3};
  camera.parallel_scale = 1.3;
  for (const double turn : {0.0, 0.3, 0.75}) jobs.push_back({scene::orbit(camera, turn), {320, 320}});
  const scene::TransferFunction opaque({{0.1, {0.2, 0.4, 1}, 0.2}, {0.5, {0.2, 0.4, 1}, 1}, {0.6, {1, 0.5, 0.2}, 200}});
  const auto source = ball();
  const auto worst_of = [&](Balance balance) {
    double worst = 0;
    Settings settings;
    settings.ranks.balance = balance;
    exchange::run_ranks(6, [&](exchange::Transport& transport) {
      volume::RenderSettings render;
      render.threads = 1;
      volume::Renderer renderer(*source, render);
      for (const VolumeJob& job : jobs)
        render_sort_first(transport, settings, {&job, 1}, opaque, renderer, [&](const FinishedVolumeFrame& frame) {
          worst = std::max(worst, deviation(samples_of(frame)));
        });
    });
    return worst;
  };
  // Edges are on every fourth pixel, so each side of a rectangle of about a hundred pixels may be off by two pixels.
  EXPECT_LT(worst_of(Balance::learned), 0.16);
  EXPECT_GT(worst_of(Balance::even), 0.3);
}

TEST(SortFirst, LearnedBalanceGoesByTheTimesOfTilesWhereViewsAreNear) {
  std::vector<VolumeJob> jobs;
  scene::Camera camera;
  camera.position = {2.5, 1.8, 3.3};
  camera.parallel_scale = 1.6;
  // The third view is far from the second, and the last image has another size.
  for (const double turn : {0.0, 0.005, 0.4, 0.405}) jobs.push_back({scene::orbit(camera, turn), {161, 107}});
  jobs.push_back({jobs.back().camera, {67, 101}});
  const auto source = ball();
  volume::RenderSettings alone;
  alone.threads = 1;
  volume::Renderer renderer(*source, alone);
  for (const int ranks : {2, 5}) {
    const auto frames = render(ranks, {}, jobs);
    ASSERT_EQ(frames.size(), jobs.size());
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      // Only edges derived from times have steps.
      EXPECT_EQ(!frames[i].split.steps.empty(), i == 1 || i == 3) << i;
      EXPECT_EQ(frames[i].image.rgba, renderer.render(jobs[i].camera, jobs[i].size, haze()).image.rgba)
          << ranks << ' ' << i;
    }
  }
}

TEST(SortFirst, WeightsShareTheWorkAndWrongOnesAreRefused) {
  Settings settings;
  settings.ranks.balance_weights = {3, 1};
  const auto frames = render(2, settings, orbit(2));
  ASSERT_EQ(frames.size(), 3u);
  // The image is about a hundred pixels wide, and edges are on every fourth pixel.
  for (const FinishedVolumeFrame& frame : frames) EXPECT_GT(frame.ranks[0].samples, 2 * frame.ranks[1].samples);
  settings.ranks.balance_weights = {1, 1, 1};
  EXPECT_THROW(static_cast<void>(render(2, settings, orbit(1))), scene::Error);
}

}  // namespace
}  // namespace tessera::frame::sort_first_test
