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

/// Entries as they are compared, but in bytes: a negative float's bits fall as it rises, a positive one's rise with it.
HWY_INLINE std::uint64_t key_of(const TileEntry& e) {
  const auto bits = std::bit_cast<std::uint32_t>(e.near_depth + 0.0f);  // -0 and 0 are one depth
  return static_cast<std::uint64_t>(bits ^ ((0u - (bits >> 31)) | 0x80000000u)) << 32 | e.tet;
}

/// Least significant digit first, over the digits in which keys differ at all. Entries in tet order, as TileLists makes
/// them, need no passes over tets: each pass keeps the order of what it finds equal.
HWY_NOINLINE void radix_sort(TileEntry* entries, TileEntry* other, std::size_t n) {
  constexpr int digit_bits = 11, digits_of_a_half = 3;  // three passes take less than four of bytes
  constexpr std::uint32_t values = 1u << digit_bits;
  bool by_tet = true;
  for (std::size_t i = 1; i < n; ++i) by_tet &= entries[i - 1].tet <= entries[i].tet;
  TileEntry *from = entries, *to = other;
  for (int half = by_tet ? 1 : 0; half < 2; ++half) {
    const auto digit_of = [half](const TileEntry& e, int digit) {
      return static_cast<std::uint32_t>(key_of(e) >> 32 * half) >> digit * digit_bits & (values - 1);
    };
    std::uint32_t next[digits_of_a_half][values] = {};
    for (std::size_t i = 0; i < n; ++i)
      for (int digit = 0; digit < digits_of_a_half; ++digit) ++next[digit][digit_of(entries[i], digit)];
    for (int digit = 0; digit < digits_of_a_half; ++digit) {
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
    if (from != entries) {
      std::copy_n(from, n, entries);
      std::swap(from, to);
    }
  }
}

HWY_INLINE bool before(const TileEntry& a, const TileEntry& b) {
  return a.near_depth < b.near_depth || (a.near_depth == b.near_depth && a.tet < b.tet);
}

/// Moves entry i to its place among those before it, which are in order. Returns by how many places.
HWY_INLINE std::size_t insert(TileEntry* entries, std::size_t i) {
  const TileEntry moving = entries[i];
  std::size_t hole = i;
  for (; hole > 0 && before(moving, entries[hole - 1]); --hole) entries[hole] = entries[hole - 1];
  entries[hole] = moving;
  return i - hole;
}

#if HWY_TARGET == HWY_SCALAR
void order(TileEntry* entries, TileEntry* other, std::uint32_t*, std::size_t n) {
  if (n > 0) radix_sort(entries, other, n);
}
#else
// An entry is two lanes: its depth in the even one, its tet in the odd one.
using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
static_assert(sizeof(TileEntry) == 8);

HWY_INLINE const float* lanes_of(const TileEntry* entries) { return reinterpret_cast<const float*>(entries); }

HWY_INLINE unsigned bits_of(hn::Mask<D> mask) {
  std::uint8_t bytes[8] = {};
  hn::StoreMaskBits(D(), mask, bytes);
  return bytes[0] | bytes[1] << 8;
}

/// Insertion sort of what is nearly in order. False, with the entries in some order, after `most_moves`.
HWY_INLINE bool insertion_sort(TileEntry* entries, std::size_t n, std::size_t most_moves) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const std::size_t step = hn::Lanes(d) / 2;
  std::size_t moves = 0;
  for (std::size_t i = 1; i < n;) {
    if (i + step <= n) {
      const V previous = hn::LoadU(d, lanes_of(entries + i - 1)), here = hn::LoadU(d, lanes_of(entries + i));
      // Depths compare in even bits, tets in odd ones.
      const unsigned deeper = bits_of(hn::Lt(previous, here)), level = bits_of(hn::Eq(previous, here));
      const unsigned later = bits_of(hn::RebindMask(d, hn::Lt(hn::BitCast(du, previous), hn::BitCast(du, here))));
      const unsigned mask = ~(deeper | (level & later >> 1)) & (step == 8 ? 0x5555u : (1u << 2 * step) / 3);
      if (HWY_LIKELY(mask == 0)) {
        i += step;
        continue;
      }
      i += static_cast<std::size_t>(std::countr_zero(mask)) / 2;
    }
    // Its successors may be out of place only now.
    for (std::size_t by = 1; by != 0 && i < n; ++i) moves += by = insert(entries, i);
    if (moves > most_moves) return false;
  }
  return true;
}

void order(TileEntry* entries, TileEntry* other, std::uint32_t* steps, std::size_t n) {
  constexpr std::size_t short_list = 24;  // no more compares than the passes below cost
  if (n <= short_list) {
    for (std::size_t i = 1; i < n; ++i) insert(entries, i);
    return;
  }
  const D d;
  const hn::RebindToSigned<D> di;
  const std::size_t step = hn::Lanes(d) / 2;
  const V first = hn::Set(d, entries[0].near_depth);
  V low = first, high = first;
  std::size_t i = 0;
  for (; i + step <= n; i += step) {
    const V depth = hn::OddEven(first, hn::LoadU(d, lanes_of(entries + i)));
    low = hn::Min(low, depth);
    high = hn::Max(high, depth);
  }
  float least = hn::GetLane(hn::MinOfLanes(d, low)), most = hn::GetLane(hn::MaxOfLanes(d, high));
  for (; i < n; ++i) {
    least = entries[i].near_depth < least ? entries[i].near_depth : least;
    most = entries[i].near_depth > most ? entries[i].near_depth : most;
  }

  // Four bits more than it takes to number the entries leave one in thirty out of place.
  const int wanted = std::bit_width(n) + 4, bits = wanted < 16 ? wanted : 16, low_bits = bits / 2;
  const std::uint32_t low_mask = (1u << low_bits) - 1;
  const float scale = static_cast<float>((1 << bits) - 1) / (most - least);
  if (!(scale > 0 && scale < HUGE_VALF)) return radix_sort(entries, other, n);
  // Rounding is monotonic, so steps are in order as depths are.
  for (i = 0; i + 2 * step <= n; i += 2 * step) {
    const auto step_of = [&](V v) HWY_ATTR {
      return hn::ConvertTo(di, hn::Mul(hn::Sub(v, hn::Set(d, least)), hn::Set(d, scale)));
    };
    const auto a = step_of(hn::LoadU(d, lanes_of(entries + i)));
    const auto b = step_of(hn::LoadU(d, lanes_of(entries + i + step)));
    hn::StoreU(hn::ConcatEven(di, b, a), di, reinterpret_cast<std::int32_t*>(steps + i));
  }
  const auto step_at = [least, scale](const TileEntry& e) {
    return static_cast<std::uint32_t>(static_cast<std::int32_t>((e.near_depth - least) * scale));
  };
  for (; i < n; ++i) steps[i] = step_at(entries[i]);

  std::uint32_t low_next[256] = {}, high_next[256] = {}, low_sum = 0, high_sum = 0;
  double crowding = 0;
  for (i = 0; i < n; ++i) {
    ++low_next[steps[i] & low_mask];
    ++high_next[steps[i] >> low_bits];
  }
  for (int digit = 0; digit < 256; ++digit) {
    const std::uint32_t low_count = low_next[digit], high_count = high_next[digit];
    low_next[digit] = low_sum;
    high_next[digit] = high_sum;
    low_sum += low_count;
    high_sum += high_count;
    crowding += static_cast<double>(high_count) * high_count;
  }
  // Entries on one step, two by two, if a high digit spreads what it has over its steps: as many moves, twice.
  if (crowding > static_cast<double>(n) * 8 * (low_mask + 1)) return radix_sort(entries, other, n);
  for (i = 0; i < n; ++i) other[low_next[steps[i] & low_mask]++] = entries[i];
  for (i = 0; i < n; ++i) entries[high_next[step_at(other[i]) >> low_bits]++] = other[i];
  if (!insertion_sort(entries, n, 4 * n)) radix_sort(entries, other, n);
}
#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(order);

void order_by_depth(std::span<TileEntry> entries, DepthOrderScratch& scratch) {
  if (scratch.entries.size() < entries.size()) {
    scratch.entries.resize(entries.size());
    scratch.steps.resize(entries.size());
  }
  HWY_DYNAMIC_DISPATCH(order)(entries.data(), scratch.entries.data(), scratch.steps.data(), entries.size());
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
