// SPDX-License-Identifier: BSD-3-Clause
// Depth order of sixteen (or eight, or four) pixels at once, one pixel per lane. Included once per instruction set
// (Highway's include guard idiom).
//
// What   A key contains the depth of a segment and its row in the lane's list. Sorting networks sort the keys of all
//        lanes at once: an exchange of two rows is a minimum and a maximum, without a branch.
// How    Batcher's odd-even merge sort in registers, 16 rows at a time; then bitonic merges of the sorted groups.
// Bits   Keys are only compared, so the order is the same on every instruction set.
// Ends   The caller must order segments whose keys have equal depth bits (PackedKeys::level()).

#if defined(TESSERA_SORTING_SORT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_SORTING_SORT_LANES_INL_H_
#undef TESSERA_SORTING_SORT_LANES_INL_H_
#else
#define TESSERA_SORTING_SORT_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "scene/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::sorting {
namespace HWY_NAMESPACE {
using namespace scene::HWY_NAMESPACE;  // vectors and operations on their lanes

/// A row is one vector of keys: row r contains element r of every lane's list. Networks in registers sort this many
/// rows.
constexpr int sort_chunk = 16;

/// With more chunks than this, a merge of n log^2 n exchanges is slower than sorting lane by lane.
constexpr int most_sort_chunks = 64;

/// Depth and row in one number, so that an exchange is a minimum and a maximum. The high bits are the distance from the
/// lane's nearest depth, with as many bits as are available; the low bits are the row. Keys are the bits of positive
/// normal floats, which have the same order as the integers.
class PackedKeys {
 public:
  /// Makes keys for depths from `nearest` to `farthest` (one pair per lane, in 32-bit steps; nearest > farthest in an
  /// empty lane) in `rows` rows, at most most_sort_chunks * sort_chunk.
  HWY_INLINE PackedKeys(VI nearest, VI farthest, std::size_t rows) : nearest_(nearest) {
    const DI d;
    const hn::RebindToUnsigned<DI> bits;
    const VI range = IfThenZeroElse(farthest < nearest, farthest - nearest);
    const auto range_bits = static_cast<int>(std::bit_width(GetLane(MaxOfLanes(bits, BitCast(bits, range)))));
    const auto row_bits = static_cast<int>(std::bit_width(rows - 1));
    up_ = std::min(row_bits, key_bits - range_bits);
    row_mask_ = Set(d, (1 << row_bits) - 1);
  }
  HWY_INLINE VI pack(VI depth, std::size_t row) const {
    const DI d;
    const hn::RebindToUnsigned<DI> bits;
    const auto behind = BitCast(bits, depth - nearest_);
    const auto shifted = up_ >= 0 ? ShiftLeftSame(behind, up_) : ShiftRightSame(behind, -up_);
    const VI number = Set(d, static_cast<std::int32_t>(row));
    return Or(AndNot(row_mask_, BitCast(d, shifted)), number) + Set(d, least_normal);
  }
  /// Returns a key that is greater than all others, for rows beyond the end of a list.
  static HWY_INLINE VI behind_all(std::size_t row) {
    return Set(DI(), most_key + static_cast<std::int32_t>(row * sort_chunk * most_sort_chunks));
  }
  /// Returns the row in a key; unspecified for keys of behind_all().
  HWY_INLINE VI row(VI key) const { return And(key, row_mask_); }
  /// Whether two keys have equal depth bits, so that the keys do not determine which depth is nearer.
  HWY_INLINE MI level(VI a, VI b) const { return Xor(a, b) < row_mask_ + Set(DI(), 1); }

 private:
  static constexpr int key_bits = 30;
  static constexpr std::int32_t least_normal = 0x00800000, most_key = least_normal + (1 << key_bits);

  VI nearest_, row_mask_;
  int up_;
};

/// The comparators of a network, in the order in which they are applied.
template <int size>
struct Network {
  int count = 0;
  int low[size] = {}, high[size] = {};
  constexpr void add(int a, int b) { low[count] = a, high[count++] = b; }
};

/// Batcher's odd-even merge sort ("Sorting networks and their applications", AFIPS 1968) of 16 elements.
constexpr Network<64> odd_even_merge_sort() {
  Network<64> n;
  for (int p = 1; p < sort_chunk; p *= 2)
    for (int k = p; k >= 1; k /= 2)
      for (int j = k % p; j <= sort_chunk - 1 - k; j += 2 * k)
        for (int i = 0; i < k && i + j + k < sort_chunk; ++i)
          if ((i + j) / (2 * p) == (i + j + k) / (2 * p)) n.add(i + j, i + j + k);
  return n;
}

/// The last stage of a bitonic sort: sorts 16 elements that first ascend and then descend.
constexpr Network<32> bitonic_merge() {
  Network<32> n;
  for (int stride = sort_chunk / 2; stride >= 1; stride /= 2)
    for (int i = 0; i < sort_chunk; ++i)
      if ((i & stride) == 0) n.add(i, i + stride);
  return n;
}

inline constexpr auto sort_network = odd_even_merge_sort();
inline constexpr auto merge_network = bitonic_merge();
static_assert(sort_network.count == 63 && merge_network.count == 32);

HWY_INLINE void exchange(VF& a, VF& b) {
  const VF low = Min(a, b);
  b = Max(a, b);
  a = low;
}

template <const auto& network, int... step>
HWY_INLINE void run_network(VF (&key)[sort_chunk], std::integer_sequence<int, step...>) {
  (exchange(key[network.low[step]], key[network.high[step]]), ...);
}

/// Runs a network on 16 rows, in registers.
template <const auto& network>
HWY_INLINE void run_on_rows(float* keys) {
  const DF d;
  const std::size_t lanes = hn::Lanes(d);
  VF key[sort_chunk];
  for (int i = 0; i < sort_chunk; ++i) key[i] = LoadU(d, keys + static_cast<std::size_t>(i) * lanes);
  run_network<network>(key, std::make_integer_sequence<int, network.count>());
  for (int i = 0; i < sort_chunk; ++i) StoreU(key[i], d, keys + static_cast<std::size_t>(i) * lanes);
}

/// Compares and exchanges rows `low` + i and `high` + i (if `reversed`: `high` - i), for all i < rows.
template <bool reversed>
HWY_INLINE void exchange_rows(float* keys, int low, int high, int rows) {
  const DF d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < rows; ++i) {
    float *a = keys + (low + i) * lanes, *b = keys + (reversed ? high - i : high + i) * lanes;
    VF key_a = LoadU(d, a), key_b = LoadU(d, b);
    exchange(key_a, key_b);
    StoreU(key_a, d, a), StoreU(key_b, d, b);
  }
}

/// Sorts every lane's keys in ascending order. There are `chunks` (1 to most_sort_chunks) times 16 rows; shorter lists
/// must be padded with keys of behind_all(). Not stable. Sorting 16 rows takes 63 exchanges of two instructions for all
/// lanes, which is about half an instruction per element with 16 lanes. Each doubling of the rows adds at least two
/// thirds of that.
///
/// Sorted groups of 16 rows are merged by Batcher's bitonic sorter in the form in which all comparisons have the same
/// direction. Rows beyond the last would contain the largest keys. Comparisons with these rows would exchange nothing,
/// and are left out.
HWY_INLINE void sort_lanes(float* keys, int chunks) {
  const auto row = static_cast<std::size_t>(hn::Lanes(DF()));
  const auto at = [&](int chunk) { return static_cast<std::size_t>(chunk * sort_chunk) * row; };
  for (int c = 0; c < chunks; ++c) run_on_rows<sort_network>(keys + at(c));
  for (int run = 1; run < chunks; run *= 2) {
    for (int low = 0; low + run < chunks; low += 2 * run) {
      const int end = chunks < low + 2 * run ? chunks : low + 2 * run, high_chunks = end - low - run;
      exchange_rows<true>(keys, (low + run - high_chunks) * sort_chunk, end * sort_chunk - 1, high_chunks * sort_chunk);
      for (int stride = run / 2; stride >= 1; stride /= 2)
        for (int c = low; c + stride < end; c += 2 * stride) {
          const int met = end - c - stride < stride ? end - c - stride : stride;
          exchange_rows<false>(keys, c * sort_chunk, (c + stride) * sort_chunk, met * sort_chunk);
        }
      for (int c = low; c < end; ++c) run_on_rows<merge_network>(keys + at(c));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::sorting
HWY_AFTER_NAMESPACE();

#endif
