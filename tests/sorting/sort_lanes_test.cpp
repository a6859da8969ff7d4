#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
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
std::size_t sort_rows(std::int32_t*, std::int32_t*, int) { return 0; }
#else
/// Returns the number of lanes.
std::size_t sort_rows(std::int32_t* keys, std::int32_t* slots, int chunks) {
  sort_lanes(keys, slots, chunks);
  return hn::Lanes(SortTag());
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
namespace {

constexpr std::size_t most_lanes = 16, chunk_rows = 16;

std::size_t lane_count() {
  std::vector<std::int32_t> keys(16 * most_lanes), slots(16 * most_lanes);
  return HWY_DYNAMIC_DISPATCH(sort_rows)(keys.data(), slots.data(), 1);
}

/// Sorts `keys` (row by row, `lanes` a row) with their own numbers as slots and checks every lane.
void expect_sorted(const std::vector<std::int32_t>& keys, int chunks, std::size_t lanes) {
  std::vector<std::int32_t> sorted = keys, slots(keys.size());
  const std::size_t rows = keys.size() / lanes;
  for (std::size_t i = 0; i < slots.size(); ++i) slots[i] = static_cast<std::int32_t>(i / lanes);
  HWY_DYNAMIC_DISPATCH(sort_rows)(sorted.data(), slots.data(), chunks);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    std::vector<bool> seen(rows);
    for (std::size_t row = 0; row < rows; ++row) {
      const auto slot = static_cast<std::size_t>(slots[row * lanes + lane]);
      ASSERT_LT(slot, rows);
      ASSERT_FALSE(seen[slot]);  // a permutation of the lane
      seen[slot] = true;
      ASSERT_EQ(sorted[row * lanes + lane], keys[slot * lanes + lane]);  // that took its keys along
      if (row > 0) {
        ASSERT_LE(sorted[(row - 1) * lanes + lane], sorted[row * lanes + lane]);
      }
    }
  }
}

TEST(SortLanes, SortsEveryLaneAndTakesSlotsAlongForAllLengths) {
  tests::for_each_instruction_set([](const char* name) {
    SCOPED_TRACE(name);
    const std::size_t lanes = lane_count();
    if (lanes == 0) return;  // scalars: the lattice is not used there
    std::mt19937 random(3);
    for (const int chunks : {1, 2, 3, 4, 5, 6, 7, 8, 11, 13, 31, 64})
      for (const std::int32_t range : {1, 3, 40, std::numeric_limits<std::int32_t>::max()})
        for (int repeat = 0; repeat < 1 + 50 / chunks; ++repeat) {
          std::uniform_int_distribution<std::int32_t> key(-range, range);
          std::vector<std::int32_t> keys(static_cast<std::size_t>(chunks) * chunk_rows * lanes);
          std::generate(keys.begin(), keys.end(), [&] { return key(random); });
          expect_sorted(keys, chunks, lanes);
        }
  });
}

/// A network that sorts all sequences of zeros and ones sorts all sequences (Knuth, The Art of Computer Programming 3,
/// 5.3.4, the zero-one principle): 2^16 of them for the first chunk, a lane each.
TEST(SortLanes, TheNetworkOfSixteenSortsAllZeroOneSequences) {
  const std::size_t lanes = lane_count();
  if (lanes == 0) GTEST_SKIP() << "no lanes on this processor";
  for (std::uint32_t first = 0; first < 1u << 16; first += static_cast<std::uint32_t>(lanes)) {
    std::vector<std::int32_t> keys(16 * lanes);
    for (std::size_t row = 0; row < 16; ++row)
      for (std::size_t lane = 0; lane < lanes; ++lane)
        keys[row * lanes + lane] = static_cast<std::int32_t>((first + lane) >> row & 1);
    expect_sorted(keys, 1, lanes);
  }
}

}  // namespace
}  // namespace tessera::sorting
#endif  // HWY_ONCE
