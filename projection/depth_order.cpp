// SPDX-License-Identifier: BSD-3-Clause
#include "projection/depth_order.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/depth_order.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Returns the depth as an integer with the same order. (The bits of negative floats descend as the float ascends;
/// those of positive floats ascend.)
HWY_INLINE std::uint32_t key_of(const TileEntry& e) {
  const auto bits = std::bit_cast<std::uint32_t>(e.near_depth);
  return bits ^ ((0u - (bits >> 31)) | 0x80000000u);
}

// If an entry's step has more entries than this, on average over all entries, the list is sorted completely: otherwise,
// segments would wait too long in their windows.
constexpr std::uint64_t crowd = 512;

/// Radix sort, least significant digit first, over the digits in which keys differ.
HWY_NOINLINE DepthOrder radix_sort(TileEntry* entries, TileEntry* other, std::size_t n) {
  constexpr int digit_bits = 11, digits = 3;  // faster than four passes with digits of 8 bits
  constexpr std::uint32_t values = 1u << digit_bits;
  const auto digit_of = [](const TileEntry& e, int digit) { return key_of(e) >> digit * digit_bits & (values - 1); };
  std::uint32_t next[digits][values] = {};
  for (std::size_t i = 0; i < n; ++i)
    for (int digit = 0; digit < digits; ++digit) ++next[digit][digit_of(entries[i], digit)];
  TileEntry *from = entries, *to = other;
  for (int digit = 0; digit < digits; ++digit) {
    if (next[digit][digit_of(entries[0], digit)] == n) continue;
    std::uint32_t sum = 0;
    for (std::uint32_t& start : next[digit]) {
      const std::uint32_t count = start;
      start = sum;
      sum += count;
    }
    for (std::size_t i = 0; i < n; ++i) to[next[digit][digit_of(from[i], digit)]++] = from[i];
    std::swap(from, to);
  }
  return {{from, n}, 0};
}

/// Sorts the few entries of a short list.
HWY_INLINE void insertion_sort(TileEntry* entries, std::size_t n) {
  for (std::size_t i = 1; i < n; ++i) {
    const TileEntry moving = entries[i];
    std::size_t hole = i;
    for (; hole > 0 && moving.near_depth < entries[hole - 1].near_depth; --hole) entries[hole] = entries[hole - 1];
    entries[hole] = moving;
  }
}

#if HWY_TARGET == HWY_SCALAR
DepthOrder order(TileEntry* entries, TileEntry* other, std::uint32_t*, std::size_t n) {
  return n > 0 ? radix_sort(entries, other, n) : DepthOrder{};
}
#else
// An entry occupies two lanes: its depth is in the even lane, its tet in the odd one.
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
static_assert(sizeof(TileEntry) == 8);

HWY_INLINE const float* lanes_of(const TileEntry* entries) { return reinterpret_cast<const float*>(entries); }

DepthOrder order(TileEntry* entries, TileEntry* other, std::uint32_t* steps, std::size_t n) {
  constexpr std::size_t short_list = 24;  // at most as many comparisons as the passes below take
  if (n <= short_list) {
    insertion_sort(entries, n);
    return {{entries, n}, 0};
  }
  const D d;
  const hn::RebindToSigned<D> di;
  const std::size_t lanes = hn::Lanes(d) / 2;
  const V first = Set(d, entries[0].near_depth);
  V low = first, high = first;
  std::size_t i = 0;
  for (; i + lanes <= n; i += lanes) {
    const V depth = OddEven(first, LoadU(d, lanes_of(entries + i)));
    low = Min(low, depth);
    high = Max(high, depth);
  }
  float least = GetLane(MinOfLanes(d, low)), most = GetLane(MaxOfLanes(d, high));
  for (; i < n; ++i) {
    least = entries[i].near_depth < least ? entries[i].near_depth : least;
    most = entries[i].near_depth > most ? entries[i].near_depth : most;
  }

  constexpr std::size_t most_steps = 4096;
  const std::size_t step_count = std::min(std::bit_ceil(n / 2), most_steps);
  const float scale = static_cast<float>(step_count - 1) / (most - least);
  if (!(scale > 0 && scale < HUGE_VALF)) return radix_sort(entries, other, n);
  // Rounding is monotonic, so steps are in the same order as depths.
  for (i = 0; i + 2 * lanes <= n; i += 2 * lanes) {
    const auto step_of = [&](V v) HWY_ATTR { return ConvertTo(di, (v - Set(d, least)) * Set(d, scale)); };
    const auto a = step_of(LoadU(d, lanes_of(entries + i)));
    const auto b = step_of(LoadU(d, lanes_of(entries + i + lanes)));
    StoreU(ConcatEven(di, b, a), di, reinterpret_cast<std::int32_t*>(steps + i));
  }
  for (; i < n; ++i)
    steps[i] = static_cast<std::uint32_t>(static_cast<std::int32_t>((entries[i].near_depth - least) * scale));

  std::uint32_t next[most_steps];
  std::fill_n(next, step_count, 0u);
  for (i = 0; i < n; ++i) ++next[steps[i]];
  std::uint32_t sum = 0;
  std::uint64_t company = 0;
  for (std::size_t step = 0; step < step_count; ++step) {
    const std::uint32_t count = next[step];
    next[step] = sum;
    sum += count;
    company += std::uint64_t{count} * count;
  }
  if (company > n * crowd) return radix_sort(entries, other, n);
  for (i = 0; i < n; ++i) other[next[steps[i]]++] = entries[i];
  // The slack is one step and the largest rounding error: step numbers are below 2^12, and have a relative error of
  // 2^-23.
  return {{other, n}, 1.01 / static_cast<double>(scale)};
}
#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(order);

DepthOrder order_by_depth(std::span<TileEntry> entries, DepthOrderScratch& scratch) {
  if (scratch.entries.size() < entries.size()) {
    scratch.entries.resize(entries.size());
    scratch.steps.resize(entries.size());
  }
  return HWY_DYNAMIC_DISPATCH(order)(entries.data(), scratch.entries.data(), scratch.steps.data(), entries.size());
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
