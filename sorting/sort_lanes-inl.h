// Depth order of sixteen (or eight, or four) pixels at once, a pixel a lane. Included once per instruction set
// (Highway's include guard idiom).

#if defined(TESSERA_SORTING_SORT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_SORTING_SORT_LANES_INL_H_
#undef TESSERA_SORTING_SORT_LANES_INL_H_
#else
#define TESSERA_SORTING_SORT_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <utility>

HWY_BEFORE_NAMESPACE();
namespace tessera::sorting {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using SortTag = hn::ScalableTag<std::int32_t>;
using SortVec = hn::Vec<SortTag>;

/// A row is one vector of keys and one of slots: element r of every lane's list.
constexpr int sort_chunk = 16;

/// The comparators of a network, in order.
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

/// Sorts 16 elements that rise and then fall.
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

HWY_INLINE void exchange(SortVec& key_a, SortVec& slot_a, SortVec& key_b, SortVec& slot_b) {
  const auto swapped = hn::Lt(key_b, key_a);
  const SortVec low = hn::Min(key_a, key_b), high = hn::Max(key_a, key_b);
  const SortVec slot_low = hn::IfThenElse(swapped, slot_b, slot_a);
  slot_b = hn::IfThenElse(swapped, slot_a, slot_b);
  slot_a = slot_low;
  key_a = low, key_b = high;
}

template <const auto& network, int... step>
HWY_INLINE void run_network(SortVec (&key)[sort_chunk], SortVec (&slot)[sort_chunk],
                            std::integer_sequence<int, step...>) {
  (exchange(key[network.low[step]], slot[network.low[step]], key[network.high[step]], slot[network.high[step]]), ...);
}

/// Runs a network on 16 rows, in registers.
template <const auto& network>
HWY_INLINE void run_on_rows(std::int32_t* keys, std::int32_t* slots) {
  const SortTag d;
  const std::size_t lanes = hn::Lanes(d);
  SortVec key[sort_chunk], slot[sort_chunk];
  for (int i = 0; i < sort_chunk; ++i) {
    key[i] = hn::LoadU(d, keys + static_cast<std::size_t>(i) * lanes);
    slot[i] = hn::LoadU(d, slots + static_cast<std::size_t>(i) * lanes);
  }
  run_network<network>(key, slot, std::make_integer_sequence<int, network.count>());
  for (int i = 0; i < sort_chunk; ++i) {
    hn::StoreU(key[i], d, keys + static_cast<std::size_t>(i) * lanes);
    hn::StoreU(slot[i], d, slots + static_cast<std::size_t>(i) * lanes);
  }
}

/// Exchanges row `low` + i with row `high` + i (reversed: `high` - i), i < rows.
template <bool reversed>
HWY_INLINE void exchange_rows(std::int32_t* keys, std::int32_t* slots, int low, int high, int rows) {
  const SortTag d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (int i = 0; i < rows; ++i) {
    const int a = (low + i) * lanes, b = (reversed ? high - i : high + i) * lanes;
    SortVec key_a = hn::LoadU(d, keys + a), slot_a = hn::LoadU(d, slots + a);
    SortVec key_b = hn::LoadU(d, keys + b), slot_b = hn::LoadU(d, slots + b);
    exchange(key_a, slot_a, key_b, slot_b);
    hn::StoreU(key_a, d, keys + a), hn::StoreU(slot_a, d, slots + a);
    hn::StoreU(key_b, d, keys + b), hn::StoreU(slot_b, d, slots + b);
  }
}

/// Beyond this many chunks a merge of n log^2 n exchanges loses to sorting lane after lane.
constexpr int most_sort_chunks = 64;

/// Sorts every lane's keys, ascending, and takes the slots along: `chunks` (1 to most_sort_chunks) times 16 rows; lists
/// that are shorter are filled up with the largest key. Not stable. Sorting 16 rows takes 63 exchanges of 5
/// instructions for all lanes, so about one instruction an element; each doubling adds two thirds of that and more.
///
/// Runs of 16 rows are merged by Batcher's bitonic sorter in the form in which all comparisons point one way: rows
/// beyond the last would hold largest keys, so that what would meet them stays.
HWY_INLINE void sort_lanes(std::int32_t* keys, std::int32_t* slots, int chunks) {
  const auto row = static_cast<std::size_t>(hn::Lanes(SortTag()));
  const auto at = [&](int chunk) { return static_cast<std::size_t>(chunk * sort_chunk) * row; };
  for (int c = 0; c < chunks; ++c) run_on_rows<sort_network>(keys + at(c), slots + at(c));
  for (int run = 1; run < chunks; run *= 2) {
    for (int low = 0; low + run < chunks; low += 2 * run) {
      const int end = chunks < low + 2 * run ? chunks : low + 2 * run, high_chunks = end - low - run;
      exchange_rows<true>(keys, slots, (low + run - high_chunks) * sort_chunk, end * sort_chunk - 1,
                          high_chunks * sort_chunk);
      for (int stride = run / 2; stride >= 1; stride /= 2)
        for (int c = low; c + stride < end; c += 2 * stride) {
          const int met = end - c - stride < stride ? end - c - stride : stride;
          exchange_rows<false>(keys, slots, c * sort_chunk, (c + stride) * sort_chunk, met * sort_chunk);
        }
      for (int c = low; c < end; ++c) run_on_rows<merge_network>(keys + at(c), slots + at(c));
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::sorting
HWY_AFTER_NAMESPACE();

#endif
