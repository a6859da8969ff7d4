// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <random>
#include <tuple>
#include <vector>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sorting/sort_windows_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sorting/sort_windows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::sorting {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
std::size_t sort_group(projection::SegmentWindows&, std::size_t, WindowOrder&) { return 0; }
#else
/// Sorts the group of pixels that begins at `pixel`. Returns the number of lanes.
std::size_t sort_group(projection::SegmentWindows& windows, std::size_t pixel, WindowOrder& order) {
  sort_windows({windows.segments() + pixel, nullptr}, windows.stride(), windows.counts() + pixel, order);
  return hn::Lanes(DI());
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace tessera::sorting
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include "support/instruction_sets.hpp"

namespace tessera::sorting {
HWY_EXPORT(sort_group);
namespace {

using Segment = projection::LatticeSegment;

auto key(const Segment& s) { return std::tie(s.front, s.back, s.scalar_front, s.scalar_back); }

/// Fills windows of 40 pixels (a multiple only of 4 and 8 lanes) with up to `most` segments each, with fronts in [0,
/// range], sorts each group, and compares every list with std::sort's.
void expect_sorted(std::size_t most, std::int32_t range, std::uint32_t seed) {
  constexpr std::size_t pixels = 40;
  projection::SegmentWindows windows;
  windows.reset(pixels, most);
  std::mt19937 random(seed);
  std::uniform_int_distribution<std::size_t> length(0, most);
  std::uniform_int_distribution<std::int32_t> front(-range / 2, range - range / 2), thickness(0, 3);
  std::vector<std::vector<Segment>> expected(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t left = p % 7 == 0 ? most : length(random); left > 0; --left) {
      const std::int32_t at = front(random);
      const Segment segment{at, at + thickness(random), static_cast<float>(thickness(random)), 0};
      ASSERT_TRUE(windows.push(p, segment));
      expected[p].push_back(segment);
    }
    std::sort(expected[p].begin(), expected[p].end(),
              [](const Segment& a, const Segment& b) { return key(a) < key(b); });
  }
  WindowOrder order;
  for (std::size_t first = 0, lanes = 1; first < pixels; first += lanes) {
    lanes = HWY_DYNAMIC_DISPATCH(sort_group)(windows, first, order);
    if (lanes == 0) return;  // without lanes the lattice is not used
    for (std::size_t p = first; p < std::min(first + lanes, pixels); ++p)
      for (std::size_t row = 0; row < expected[p].size(); ++row) {
        const auto slot = static_cast<std::size_t>(order.slots[row * lanes + p - first]);
        const Segment& found = windows.segments()[p + slot / sizeof(Segment)];
        ASSERT_EQ(key(found), key(expected[p][row])) << "pixel " << p << ", row " << row;
      }
  }
}

/// Ranges of one depth, of many ties, of more bits than keys have besides the row, and lists of all lengths: in one
/// network, merged, and too long for networks (more than 1,024).
TEST(SortWindows, OrdersEveryListUnderEveryInstructionSet) {
  tests::for_each_instruction_set([](const char* name) {
    SCOPED_TRACE(name);
    std::uint32_t seed = 1;
    for (const std::size_t most : {1, 5, 16, 17, 64, 200, 1500})
      for (const std::int32_t range : {0, 12, 1 << 16, 2000000000}) expect_sorted(most, range, ++seed);
  });
}

}  // namespace
}  // namespace tessera::sorting
#endif  // HWY_ONCE
