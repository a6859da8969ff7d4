// SPDX-License-Identifier: BSD-3-Clause
#include "scene/sample_source.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "scene/error.hpp"
#include "scene/threshold_source.hpp"

namespace tessera::scene {
namespace {

Grid grid_of(GridIndex points) {
  Grid grid;
  grid.geometry.points = points;
  return grid;
}

std::vector<std::uint16_t> counting(std::size_t count) {
  std::vector<std::uint16_t> values(count);
  std::iota(values.begin(), values.end(), std::uint16_t{0});
  return values;
}

TEST(SampleSource, ABoxHoldsItsSamplesWithTheFirstAxisFastest) {
  const auto source = MemorySource::of(grid_of({4, 3, 5}), counting(60));
  std::vector<float> box(2 * 1 * 2);
  source->read({{1, 2, 3}, {3, 3, 5}}, std::span<float>(box));
  EXPECT_EQ(box, (std::vector<float>{45, 46, 57, 58}));  // ((k * 3) + j) * 4 + i
}

TEST(SampleSource, PitchesLeaveRoomBetweenRowsAndSlicesUntouched) {
  const auto source = MemorySource::of(grid_of({4, 3, 5}), counting(60));
  std::vector<std::uint16_t> box(11, 999);
  source->read({{0, 0, 0}, {2, 2, 2}}, {SampleType::uint16, 3, 6}, std::as_writable_bytes(std::span(box)));
  EXPECT_EQ(box, (std::vector<std::uint16_t>{0, 1, 999, 4, 5, 999, 12, 13, 999, 16, 17}));
}

TEST(SampleSource, SwappedInterleavedAndUnalignedSamplesAreRead) {
  const std::vector<std::int16_t> numbers = {-2, 3, 4, 5, 6, -7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
  std::vector<std::byte> bytes(1);  // odd address
  for (const std::int16_t n : numbers) {
    const auto u = static_cast<std::uint16_t>(n);
    bytes.push_back(static_cast<std::byte>(u >> 8));
    bytes.push_back(static_cast<std::byte>(u & 0xff));
  }
  Grid grid = grid_of({2, 2, 2});
  grid.type = SampleType::int16;
  const auto payload = std::span<const std::byte>(bytes).subspan(1);
  const bool swapped = std::endian::native == std::endian::little;
  const MemorySource second(grid, payload, nullptr, "v", ComponentChoice{2, 1, SampleType::int16}, swapped);
  std::vector<std::int16_t> samples(8);
  second.read(grid.geometry.all_samples(), std::span<std::int16_t>(samples));
  EXPECT_EQ(samples, (std::vector<std::int16_t>{3, 5, -7, 9, 11, 13, 15, 17}));
  grid.type = SampleType::float32;
  const MemorySource length(grid, payload, nullptr, "v", ComponentChoice{2, -1, SampleType::int16}, swapped);
  std::vector<double> lengths(8);
  length.read(grid.geometry.all_samples(), std::span<double>(lengths));
  EXPECT_EQ(lengths[0], std::sqrt(13.0));
  EXPECT_EQ(lengths[2], std::sqrt(85.0));
}

TEST(SampleSource, RangeLeavesBlanksOutAndMeansValuesNotSamples) {
  std::vector<double> values(2 * 3 * 4, 1);
  values[3] = std::nan("");
  values[4] = std::numeric_limits<double>::infinity();
  values[7] = 5;
  values[23] = -2;
  Grid grid = grid_of({2, 3, 4});
  grid.scale = -2;
  grid.shift = 10;
  const ValueRange range = value_range(*MemorySource::of(grid, values));
  EXPECT_EQ(range, (ValueRange{0, 14, 2}));
  EXPECT_TRUE(value_range(*MemorySource::of(grid, std::vector<float>(24, std::nanf("")))).empty());
}

TEST(ThresholdSource, BlanksSamplesOutsideTheRangeAndKeepsOthers) {
  Grid grid = grid_of({4, 3, 5});
  grid.scale = -0.5;
  grid.shift = 20;                                                                  // values from 20 down to -9.5
  const ThresholdSource kept(MemorySource::of(grid, counting(60)), {4, 7.5}, "v");  // samples 25 to 32
  EXPECT_EQ(kept.grid().type, SampleType::float32);
  EXPECT_EQ(value_range(kept), (ValueRange{4, 7.5, 52}));
  // Rows and slices with gaps, in both float types.
  const SampleBox box{{1, 0, 1}, {3, 3, 4}};
  std::vector<float> narrow(200, -1);
  kept.read(box, {SampleType::float32, 5, 40}, std::as_writable_bytes(std::span<float>(narrow)));
  std::vector<double> wide(static_cast<std::size_t>(box.count()));
  kept.read(box, std::span<double>(wide));
  for (std::int64_t k = 0, n = 0; k < 3; ++k)
    for (std::int64_t j = 0; j < 3; ++j) {
      for (std::int64_t i = 0; i < 2; ++i, ++n) {
        const double sample = double(i + 1 + 4 * (j + 3 * (k + 1)));
        const bool is_kept = sample >= 25 && sample <= 32;
        const float a = narrow[static_cast<std::size_t>(i + 5 * j + 40 * k)];
        const double b = wide[static_cast<std::size_t>(n)];
        EXPECT_EQ(std::isnan(a), !is_kept) << sample;
        EXPECT_EQ(std::isnan(b), !is_kept) << sample;
        EXPECT_EQ(is_kept ? a : sample, sample);
        EXPECT_EQ(is_kept ? b : sample, sample);
      }
      EXPECT_EQ(narrow[static_cast<std::size_t>(2 + 5 * j + 40 * k)], -1);  // between rows
    }
  const ThresholdSource doubles(MemorySource::of(grid, std::vector<double>(60, 1 + 1e-12)), {0, 19.6}, "v");
  EXPECT_EQ(doubles.grid().type, SampleType::float64);
  EXPECT_EQ(value_range(doubles).blanks, 0u);
}

TEST(SampleSource, TooFewBytesAndABoxOutsideAreRefused) {
  EXPECT_THROW(MemorySource::of(grid_of({4, 3, 5}), counting(59)), Error);
  const auto source = MemorySource::of(grid_of({4, 3, 5}), counting(60));
  std::vector<float> room(60);
  EXPECT_THROW(source->read({{0, 0, 0}, {5, 1, 1}}, std::span<float>(room)), Error);
  EXPECT_THROW(source->read({{0, 0, 0}, {4, 3, 5}}, std::span<float>(room).subspan(1)), Error);
  EXPECT_THROW(
      source->read({{0, 0, 0}, {4, 3, 5}}, std::span<std::uint8_t>(reinterpret_cast<std::uint8_t*>(room.data()), 60)),
      Error);
  EXPECT_NO_THROW(source->read({{0, 0, 0}, {4, 0, 5}}, std::span<float>()));
}

}  // namespace
}  // namespace tessera::scene
