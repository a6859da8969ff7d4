// SPDX-License-Identifier: BSD-3-Clause
// Lists of images of a volume, where the next one is cast while the previous one is gathered.
#include "frame/grid/volume_frames.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <vector>

#include "exchange/loopback_transport.hpp"
#include "frame/grid/sort_first.hpp"
#include "frame/grid/sort_last.hpp"
#include "frame/small_grid.hpp"
#include "scene/error.hpp"
#include "scene/sample_source.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::frame::volume_frames_test {
namespace {

constexpr scene::ImageSize size{70, 50};
constexpr std::size_t pictures = 7;

std::unique_ptr<scene::MemorySource> waves() {
  return small_grid(33,
                    [](const glm::dvec3& p) { return 0.5 + 0.5 * std::sin(4.8 * p.x) * std::cos(3.2 * (p.y + p.z)); });
}

scene::TransferFunction haze() { return scene::TransferFunction({{0.1, {0.2, 0.4, 1}, 0}, {0.9, {1, 0.5, 0.2}, 5}}); }

std::vector<VolumeJob> turn() {
  std::vector<VolumeJob> jobs;
  scene::Camera camera;
  camera.position = {2.5, 1.8, 3.3};
  camera.parallel_scale = 1.6;
  for (std::size_t i = 0; i < pictures; ++i) jobs.push_back({scene::orbit(camera, double(i) / pictures), size});
  return jobs;
}

enum class SortMode { first, last };

std::unique_ptr<VolumeFrames> frames_of(SortMode mode, exchange::Transport& transport) {
  if (mode == SortMode::first) return std::make_unique<SortFirst>(transport, Settings{});
  return std::make_unique<SortLast>(transport, Settings{});
}

/// Calls `work` on every rank with its renderer, its frames and the list.
void on_ranks(SortMode mode, int ranks, const scene::SampleSource& source,
              const std::function<void(exchange::Transport&, volume::Renderer&, VolumeFrames&)>& work) {
  const auto ranges = std::make_shared<const volume::CellRanges>(source);
  exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
    volume::RenderSettings settings;
    settings.threads = 1;
    settings.grid.brick_size = 8;
    settings.parts = mode == SortMode::last ? ranks : 1;
    volume::Renderer renderer(source, settings, ranges);
    const auto frames = frames_of(mode, transport);
    work(transport, renderer, *frames);
  });
}

class VolumeLists : public testing::TestWithParam<SortMode> {};
INSTANTIATE_TEST_SUITE_P(SortModes, VolumeLists, testing::Values(SortMode::first, SortMode::last),
                         [](const auto& mode) { return mode.param == SortMode::first ? "SortFirst" : "SortLast"; });

TEST_P(VolumeLists, GiveTheBitsOfSeparateImagesInOrderAndReportEveryPixelOnce) {
  const auto source = waves();
  const std::vector<VolumeJob> jobs = turn();
  for (const int ranks : {1, 2, 5}) {
    std::vector<scene::Image> one_by_one;
    on_ranks(GetParam(), ranks, *source, [&](exchange::Transport&, volume::Renderer& renderer, VolumeFrames& frames) {
      for (std::size_t i = 0; i < jobs.size(); ++i)
        if (auto made = frames.render(renderer, haze(), jobs[i], i)) one_by_one.push_back(std::move(made->image));
    });
    ASSERT_EQ(one_by_one.size(), pictures);
    for (const int in_flight : {1, 2, 4}) {
      std::vector<std::size_t> order;
      std::vector<std::vector<int>> reported(pictures,
                                             std::vector<int>(static_cast<std::size_t>(size.width * size.height)));
      VolumeCallbacks callbacks;
      callbacks.frame = [&](FinishedVolumeFrame&& frame) {
        EXPECT_FALSE(frame.stopped);
        EXPECT_EQ(frame.image.rgba, one_by_one[frame.frame].rgba) << ranks << " ranks, picture " << frame.frame;
        EXPECT_EQ(frame.image.depth, one_by_one[frame.frame].depth);
        order.push_back(frame.frame);
      };
      callbacks.tile = [&](std::size_t frame, const scene::PixelRect& r, const scene::Image& image) {
        for (int y = r.y0; y < r.y1; ++y)
          for (int x = r.x0; x < r.x1; ++x) {
            ++reported[frame][image.index(x, y)];
            const std::size_t at = 4 * image.index(x, y);
            for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(image.rgba[at + c], one_by_one[frame].rgba[at + c]);
          }
      };
      on_ranks(GetParam(), ranks, *source,
               [&](exchange::Transport& transport, volume::Renderer& renderer, VolumeFrames& frames) {
                 const VolumeCallbacks none{[](FinishedVolumeFrame&&) { FAIL(); }, {}};
                 EXPECT_EQ(
                     frames.render(renderer, haze(), jobs, 20, transport.rank() == 0 ? callbacks : none, {}, in_flight),
                     pictures);
               });
      ASSERT_EQ(order.size(), pictures);
      for (std::size_t i = 0; i < pictures; ++i) EXPECT_EQ(order[i], i);
      for (const auto& pixels : reported)
        for (const int count : pixels) ASSERT_EQ(count, 1);
    }
  }
}

TEST_P(VolumeLists, AStopOnAnyRankEndsTheListOnAllAtOnePicture) {
  const auto source = waves();
  const std::vector<VolumeJob> jobs = turn();
  for (const int asker : {0, 2}) {
    std::stop_source stop;
    std::atomic<std::size_t> handed_out = 0;
    std::vector<std::size_t> complete(3);
    std::size_t whole_after = 0;
    on_ranks(GetParam(), 3, *source,
             [&](exchange::Transport& transport, volume::Renderer& renderer, VolumeFrames& frames) {
               VolumeCallbacks callbacks;
               callbacks.frame = [&](FinishedVolumeFrame&& frame) {
                 if (!frame.stopped) ++handed_out;
                 if (handed_out == 2) stop.request_stop();
               };
               const auto rank = static_cast<std::size_t>(transport.rank());
               complete[rank] = frames.render(renderer, haze(), jobs, 0, callbacks,
                                              transport.rank() == asker ? stop.get_token() : std::stop_token(), 2);
               const std::size_t after = frames.render(renderer, haze(), jobs, 0, callbacks, {}, 2);
               if (rank == 0) whole_after = after;
             });
    EXPECT_GE(complete[0], 2u);
    EXPECT_LT(complete[0], pictures);
    EXPECT_EQ(complete[1], complete[0]);
    EXPECT_EQ(complete[2], complete[0]);
    EXPECT_EQ(whole_after, pictures);
  }
}

struct OfCaller : std::runtime_error {
  using std::runtime_error::runtime_error;
};

TEST_P(VolumeLists, ACallbacksExceptionReachesTheCallerAndTheOthersGoOn) {
  const auto source = waves();
  const std::vector<VolumeJob> jobs = turn();
  for (const bool by_tile : {false, true})
    for (const int ranks : {1, 3}) {
      std::atomic<int> thrown = 0;
      std::vector<std::size_t> complete(3, 99);
      on_ranks(GetParam(), ranks, *source,
               [&](exchange::Transport& transport, volume::Renderer& renderer, VolumeFrames& frames) {
                 VolumeCallbacks callbacks;
                 callbacks.frame = [&](FinishedVolumeFrame&& frame) {
                   if (!by_tile && frame.frame == 2) throw OfCaller("enough");
                 };
                 callbacks.tile = [&](std::size_t frame, const scene::PixelRect&, const scene::Image&) {
                   if (by_tile && frame == 2) throw OfCaller("enough");
                 };
                 try {
                   complete[static_cast<std::size_t>(transport.rank())] =
                       frames.render(renderer, haze(), jobs, 0, callbacks, {}, 2);
                 } catch (const OfCaller&) {
                   EXPECT_EQ(transport.rank(), 0);
                   ++thrown;
                 }
                 std::size_t after = 0;
                 callbacks.frame = [&](FinishedVolumeFrame&&) { ++after; };
                 callbacks.tile = {};
                 EXPECT_EQ(frames.render(renderer, haze(), jobs, 0, callbacks, {}, 2), pictures);
                 EXPECT_EQ(after, transport.rank() == 0 ? pictures : 0);
               });
      EXPECT_EQ(thrown, 1);
      for (int rank = 1; rank < ranks; ++rank) EXPECT_LE(complete[static_cast<std::size_t>(rank)], 2u);
    }
}

/// A source whose bricks cannot be read after some reads.
class Failing final : public scene::SampleSource {
 public:
  explicit Failing(const scene::SampleSource& all) : SampleSource(all.grid(), "failing"), all_(all) {}
  mutable std::atomic<int> left = 1000000;

 private:
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout,
                    std::byte* destination) const override {
    if (--left < 0) throw scene::Error(scene::ErrorCode::system_failure, "the disk is gone");
    all_.read(box, layout, {destination, static_cast<std::size_t>(1) << 40});
  }
  const scene::SampleSource& all_;
};

TEST_P(VolumeLists, AFaultOnAnyRankEndsTheRunOnAll) {
  const auto source = waves();
  const std::vector<VolumeJob> jobs = turn();
  const auto ranges = std::make_shared<const volume::CellRanges>(*source);
  for (const int faulty : {0, 1, 2}) {
    std::atomic<int> failed = 0;
    const auto run = [&](exchange::Transport& transport) {
      const Failing failing(*source);
      failing.left = transport.rank() == faulty ? 5 : 1000000;
      volume::RenderSettings settings;
      settings.threads = 1, settings.grid.brick_size = 8, settings.parts = GetParam() == SortMode::last ? 3 : 1;
      volume::Renderer renderer(failing, settings, ranges);
      const auto frames = frames_of(GetParam(), transport);
      const VolumeCallbacks callbacks{[](FinishedVolumeFrame&&) {}, {}};
      try {
        frames->render(renderer, haze(), jobs, 0, callbacks, {}, 2);
      } catch (const scene::Error& error) {
        EXPECT_NE(std::string(error.what()).find("the disk is gone"), std::string::npos) << error.what();
        ++failed;
        throw;
      }
    };
    EXPECT_THROW(exchange::run_ranks(3, run), scene::Error);
    EXPECT_EQ(failed, 3) << "rank " << faulty << " failed";
  }
}

}  // namespace
}  // namespace tessera::frame::volume_frames_test
