// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/scan_together.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <random>
#include <string>

#include "exchange/loopback_transport.hpp"
#include "scene/error.hpp"

namespace tessera::frame::scan_together_test {
namespace {

/// Noise with blanks on a grid that is 45 voxels high, which are 6 layers of cells. Counts the samples read; layers
/// from `broken` on cannot be read.
class NoiseSource final : public scene::SampleSource {
 public:
  explicit NoiseSource(std::int64_t broken = 1000) : SampleSource(noise_grid(), "noise"), broken_(broken) {
    std::mt19937 random(11);
    values_.resize(static_cast<std::size_t>(geometry().all_samples().count()));
    for (float& v : values_) v = random() % 40 == 0 ? NAN : static_cast<float>(random()) * 0x1p-30f - 1;
    whole_ = scene::MemorySource::of(grid(), values_);
  }
  [[nodiscard]] std::int64_t samples_read() const { return samples_read_; }

 private:
  static scene::Grid noise_grid() {
    scene::Grid grid;
    grid.geometry.points = {30, 12, 46};
    return grid;
  }
  void read_samples(const scene::SampleBox& box, const scene::SampleLayout& layout, std::byte* to) const override {
    if (box.high[2] > broken_)
      throw scene::Error(scene::ErrorCode::system_failure, "noise: it cannot be read; write the file again");
    samples_read_ += box.count();
    whole_->read(box, layout, {to, static_cast<std::size_t>(box.count()) * scene::size_of(layout.type)});
  }

  std::int64_t broken_;
  std::vector<float> values_;
  std::unique_ptr<scene::MemorySource> whole_;
  mutable std::atomic<std::int64_t> samples_read_ = 0;
};

TEST(ScanTogether, EveryRankHasTheRangesOfOneProcessAndHasReadItsShareOnly) {
  const NoiseSource alone;
  const volume::CellRanges expected(alone);
  const std::int64_t layer = 30 * 12;  // samples
  for (const int ranks : {1, 2, 3, 6, 9}) {
    std::mutex mutex;
    int done = 0;
    exchange::run_ranks(ranks, [&](exchange::Transport& transport) {
      // The scan runs twice in a row, as for a series whose second step is requested. The two scans must not mix.
      for (int time = 0; time < 2; ++time) {
        const NoiseSource source;
        const volume::CellRanges ranges = scan_together(transport, source);
        const std::lock_guard lock(mutex);
        ++done;
        EXPECT_EQ(ranges.cells, expected.cells);
        EXPECT_EQ(ranges.low, expected.low) << ranks;
        EXPECT_EQ(ranges.high, expected.high) << ranks;
        EXPECT_EQ(ranges.range, expected.range);
        EXPECT_EQ(ranges.lanes.factor, expected.lanes.factor);
        EXPECT_EQ(ranges.lanes.term, expected.lanes.term);
        // Each rank reads at most one layer of cells (8 voxels) more than other ranks, and the samples above its last
        // layer.
        EXPECT_LE(source.samples_read(), ((6 + ranks - 1) / ranks * 8 + 1) * layer) << ranks;
      }
    });
    EXPECT_EQ(done, 2 * ranks);
  }
}

TEST(ScanTogether, AReadErrorOfOneRankEndsTheRunForAllWithItsMessage) {
  try {
    exchange::run_ranks(3, [&](exchange::Transport& transport) {
      const NoiseSource source(40);  // in the layers of the last rank
      scan_together(transport, source);
      ADD_FAILURE() << "rank " << transport.rank() << " went on";
    });
    FAIL() << "no error";
  } catch (const scene::Error& error) {
    EXPECT_EQ(error.code(), scene::ErrorCode::system_failure);
    EXPECT_EQ(std::string(error.what()), "noise: it cannot be read; write the file again");
  }
}

}  // namespace
}  // namespace tessera::frame::scan_together_test
