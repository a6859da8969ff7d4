// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sorting/sort_lanes_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sorting/sort_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::sorting {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
std::size_t sort_rows(float*, int) { return 0; }
std::size_t pack_and_sort(std::int32_t*, const std::int32_t*, std::int32_t*, std::int32_t*, std::size_t) { return 0; }
#else
/// Returns the number of lanes.
std::size_t sort_rows(float* keys, int chunks) {
  sort_lanes(keys, chunks);
  return hn::Lanes(DF());
}

/// Sorts `rows` rows of depths like windows, with counts[i] depths in lane i. Afterwards, places[] contains the rows in
/// sorted order, and level[row] has bits set in lanes where that row's key equals the previous one.
std::size_t pack_and_sort(std::int32_t* depths, const std::int32_t* counts, std::int32_t* places, std::int32_t* level,
                          std::size_t rows) {
  const DI d;
  const std::size_t lanes = hn::Lanes(d);
  const VI count = hn::LoadU(d, counts);
  const auto has = [&](std::size_t row)
                       HWY_ATTR { return hn::Lt(hn::Set(DI(), static_cast<std::int32_t>(row)), count); };
  VI nearest = hn::Set(d, 0x7fffffff), farthest = hn::Set(d, -0x7fffffff);
  for (std::size_t row = 0; row < rows; ++row) {
    const VI depth = hn::LoadU(d, depths + row * lanes);
    nearest = hn::Min(nearest, hn::IfThenElse(has(row), depth, nearest));
    farthest = hn::Max(farthest, hn::IfThenElse(has(row), depth, farthest));
  }
  const PackedKeys packed(nearest, farthest, rows);
  std::vector<float> keys(rows * lanes);
  for (std::size_t row = 0; row < rows; ++row) {
    const VI depth = hn::LoadU(d, depths + row * lanes);
    const VI key = hn::IfThenElse(has(row), packed.pack(depth, row), packed.behind_all(row));
    hn::StoreU(hn::BitCast(DF(), key), DF(), &keys[row * lanes]);
  }
  sort_lanes(keys.data(), static_cast<int>(rows) / sort_chunk);
  VI before = hn::Zero(d);
  for (std::size_t row = 0; row < rows; ++row) {
    const VI key = hn::BitCast(d, hn::LoadU(DF(), &keys[row * lanes]));
    hn::StoreU(packed.row(key), d, places + row * lanes);
    hn::StoreU(hn::VecFromMask(d, packed.level(before, key)), d, level + row * lanes);
    before = key;
  }
  return lanes;
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace tessera::sorting
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include "support/instruction_sets.hpp"

namespace tessera::sorting {
HWY_EXPORT(sort_rows);
HWY_EXPORT(pack_and_sort);
namespace {

constexpr std::size_t most_lanes = 16, chunk_rows = 16;

std::size_t lane_count() {
  std::vector<float> keys(chunk_rows * most_lanes);
  return HWY_DYNAMIC_DISPATCH(sort_rows)(keys.data(), 1);
}

/// Sorts `keys` (row by row, `lanes` per row) and compares every lane with std::sort.
void expect_sorted(std::vector<float> keys, int chunks, std::size_t lanes) {
  const std::vector<float> before = keys;
  const std::size_t rows = keys.size() / lanes;
  HWY_DYNAMIC_DISPATCH(sort_rows)(keys.data(), chunks);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    std::vector<float> sorted, expected;
    for (std::size_t row = 0; row < rows; ++row) {
      sorted.push_back(keys[row * lanes + lane]);
      expected.push_back(before[row * lanes + lane]);
    }
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(sorted, expected);
  }
}

TEST(SortLanes, SortsEveryLaneForAllLengths) {
  tests::for_each_instruction_set([](const char* name) {
    SCOPED_TRACE(name);
    const std::size_t lanes = lane_count();
    if (lanes == 0) return;  // without lanes the lattice is not used
    std::mt19937 random(3);
    for (const int chunks : {1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 31, 64})
      for (const int range : {1, 3, 40, 1 << 20})
        for (int repeat = 0; repeat < 1 + 50 / chunks; ++repeat) {
          std::uniform_int_distribution<int> key(1, range);
          std::vector<float> keys(static_cast<std::size_t>(chunks) * chunk_rows * lanes);
          std::generate(keys.begin(), keys.end(), [&] { return static_cast<float>(key(random)); });
          expect_sorted(keys, chunks, lanes);
        }
  });
}

/// A network that sorts all sequences of zeros and ones sorts all sequences (Knuth, The Art of Computer Programming 3,
/// 5.3.4, the zero-one principle): 2^16 of them for the first chunk, one per lane.
TEST(SortLanes, TheNetworkOfSixteenSortsAllZeroOneSequences) {
  const std::size_t lanes = lane_count();
  if (lanes == 0) GTEST_SKIP() << "no lanes on this processor";
  for (std::uint32_t first = 0; first < 1u << 16; first += static_cast<std::uint32_t>(lanes)) {
    std::vector<float> keys(16 * lanes);
    for (std::size_t row = 0; row < 16; ++row)
      for (std::size_t lane = 0; lane < lanes; ++lane)
        keys[row * lanes + lane] = static_cast<float>((first + lane) >> row & 1);
    expect_sorted(keys, 1, lanes);
  }
}

/// Depths as far apart as 32 bits allow leave no bits for the row: keys then drop their lowest bits, and must report
/// it.
TEST(PackedKeys, OrderDepthsOrReportThatTheyDoNot) {
  tests::for_each_instruction_set([](const char* name) {
    SCOPED_TRACE(name);
    const std::size_t lanes = lane_count();
    if (lanes == 0) return;
    std::mt19937 random(7);
    const std::int32_t least = std::numeric_limits<std::int32_t>::min(), most = 0x7ffffffe;
    for (const std::size_t rows : {16, 32, 256, 1024})
      for (const auto& [low, high] : {std::pair{0, 0}, std::pair{-3, 3}, std::pair{-1000000, 1000000},
                                      std::pair{0, most}, std::pair{least, most}, std::pair{most - 9, most}}) {
        SCOPED_TRACE(testing::Message() << rows << " rows from " << low << " to " << high);
        std::vector<std::int32_t> depths(rows * lanes), places(rows * lanes), level(rows * lanes), counts(lanes);
        for (std::int32_t& depth : depths) depth = std::uniform_int_distribution<std::int32_t>(low, high)(random);
        for (std::size_t lane = 0; lane < lanes; ++lane) counts[lane] = static_cast<std::int32_t>(lane * rows / lanes);
        counts.back() = static_cast<std::int32_t>(rows);
        HWY_DYNAMIC_DISPATCH(pack_and_sort)(depths.data(), counts.data(), places.data(), level.data(), rows);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
          const auto count = static_cast<std::size_t>(counts[lane]);
          std::vector<bool> seen(rows);
          for (std::size_t row = 0; row < rows; ++row) {
            const auto place = static_cast<std::size_t>(places[row * lanes + lane]);
            ASSERT_LT(place, rows);  // the positions are readable, also after the end
            if (row >= count) continue;
            ASSERT_LT(place, count);
            ASSERT_FALSE(seen[place]);
            seen[place] = true;
            if (row == 0) continue;
            const std::int32_t before =
                depths[static_cast<std::size_t>(places[(row - 1) * lanes + lane]) * lanes + lane];
            const std::int32_t here = depths[place * lanes + lane];
            const bool is_level = level[row * lanes + lane] != 0;
            ASSERT_TRUE(before < here || is_level) << before << " " << here;
            // If depths are at most 2^20 apart, no bits are dropped, and only equal depths have equal keys.
            if (std::int64_t{high} - low < 1 << 20) {
              ASSERT_EQ(is_level, before == here);
            }
          }
        }
      }
  });
}

}  // namespace
}  // namespace tessera::sorting
#endif  // HWY_ONCE
