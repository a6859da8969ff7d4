// SPDX-License-Identifier: BSD-3-Clause
// Depth order of the windows (projection::SegmentWindows) on the integer lattice: sorts the lists of as many
// neighbouring pixels at once as a vector has lanes. Included once per instruction set (Highway's include guard idiom).
//
// What   Finds, for every lane, the slots of its pixel's segments in the order of before(): front, back, then the
//        scalars.
// How    The networks of sort_lanes-inl.h sort keys that contain the fronts. Segments whose keys have equal depth bits,
//        and lists longer than the networks, are sorted lane by lane.
// Ends   Segments with equal fields are interchangeable: any order of them gives the same pixel.

#if defined(TESSERA_SORTING_SORT_WINDOWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_SORTING_SORT_WINDOWS_INL_H_
#undef TESSERA_SORTING_SORT_WINDOWS_INL_H_
#else
#define TESSERA_SORTING_SORT_WINDOWS_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "projection/lattice/segment_windows.hpp"
#include "sorting/sort_lanes-inl.h"
#include "sorting/window_order.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::sorting {
namespace HWY_NAMESPACE {

/// Returns the segment that is `slot` bytes after `list`. Slots are in bytes because this saves a shift in the address.
HWY_INLINE const projection::LatticeSegment& segment_at(const projection::LatticeSegment* list, std::int32_t slot) {
  return *reinterpret_cast<const projection::LatticeSegment*>(reinterpret_cast<const char*>(list) + slot);
}

/// A pixel's list: its first segment, and its first light; the latter is null if segments have no lights.
struct PixelList {
  const projection::LatticeSegment* segments;
  const projection::SegmentLight* lights;

  HWY_INLINE PixelList of_lane(std::size_t lane) const {
    return {segments + lane, lights != nullptr ? lights + lane : nullptr};
  }
  /// A light is half as long as a segment, so its offset is half of the slot.
  HWY_INLINE const projection::SegmentLight& light_at(std::int32_t slot) const {
    static_assert(2 * sizeof(projection::SegmentLight) == sizeof(projection::LatticeSegment));
    return *reinterpret_cast<const projection::SegmentLight*>(reinterpret_cast<const char*>(lights) + slot / 2);
  }
};

/// Whether segment a precedes segment b of the same pixel: by front, back, the scalars, then the light. Segments that
/// are equal in all of these are interchangeable.
HWY_INLINE bool before(const PixelList& list, std::int32_t slot_a, std::int32_t slot_b) {
  const projection::LatticeSegment &a = segment_at(list.segments, slot_a), &b = segment_at(list.segments, slot_b);
  if (a.front != b.front) return a.front < b.front;
  if (a.back != b.back) return a.back < b.back;
  if (a.scalar_front != b.scalar_front) return a.scalar_front < b.scalar_front;
  if (a.scalar_back != b.scalar_back || list.lights == nullptr) return a.scalar_back < b.scalar_back;
  const projection::SegmentLight &on_a = list.light_at(slot_a), &on_b = list.light_at(slot_b);
  return on_a.own != on_b.own ? on_a.own < on_b.own : on_a.white < on_b.white;
}

/// Returns the lanes whose lists have this row.
HWY_INLINE MI has_row(std::size_t row, VI count) { return Set(DI(), static_cast<std::int32_t>(row)) < count; }

/// Completes the order of a list that the network has left nearly sorted: keys contain only the front, and not always
/// all of its bits.
HWY_NOINLINE inline void settle_ties(const PixelList& list, std::size_t count, std::size_t lanes, std::int32_t* slots) {
  for (std::size_t i = 1; i < count; ++i) {
    const std::int32_t slot = slots[i * lanes];
    std::size_t hole = i;
    for (; hole > 0 && before(list, slot, slots[(hole - 1) * lanes]); --hole)
      slots[hole * lanes] = slots[(hole - 1) * lanes];
    slots[hole * lanes] = slot;
  }
}

/// Sorts the list of one lane if the list is too long for the networks.
HWY_NOINLINE inline void sort_long(const PixelList& list, std::size_t stride, std::size_t count, std::size_t lanes,
                                   std::int32_t* slots) {
  std::vector<std::int32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::int32_t>(i * stride * sizeof *list.segments);
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) { return before(list, i, j); });
  for (std::size_t i = 0; i < count; ++i) slots[i * lanes] = order[i];
}

/// Sorts the lists of as many consecutive pixels as a vector has lanes, one list per lane. `lists` is the list of the
/// first pixel. `stride` and `counts` are those of the windows; `counts` begins with that pixel. Returns the number of
/// rows, which is the length of the longest list.
HWY_INLINE std::size_t sort_windows(const PixelList& lists, std::size_t stride, const std::uint32_t* counts,
                                    WindowOrder& order) {
  const projection::LatticeSegment* const list = lists.segments;
  const DI d;
  const DF df;
  const std::size_t lanes = hn::Lanes(d);
  const VI count = LoadU(d, reinterpret_cast<const std::int32_t*>(counts));
  const auto most = static_cast<std::size_t>(GetLane(MaxOfLanes(d, count)));
  if (most == 0) return 0;
  const std::size_t chunks = (most + sort_chunk - 1) / sort_chunk;
  const std::size_t rows = chunks * sort_chunk;
  if (order.keys.size() < rows * lanes) order.keys.resize(rows * lanes), order.slots.resize(rows * lanes);
  std::int32_t* slots = order.slots.data();
  if (chunks > static_cast<std::size_t>(most_sort_chunks)) {
    for (std::size_t lane = 0; lane < lanes; ++lane)
      sort_long(lists.of_lane(lane), stride, counts[lane], lanes, slots + lane);
    return most;
  }

  VI nearest = Set(d, 0x7fffffff), farthest = Set(d, -0x7fffffff);
  for (std::size_t row = 0; row < most; ++row) {
    const std::size_t first = row * stride;
    const auto quarter = [&](std::size_t q) HWY_ATTR {
      return LoadU(d, reinterpret_cast<const std::int32_t*>(list + first + q * lanes / 4));
    };
    const VI low = ConcatEven(d, quarter(1), quarter(0)), high = ConcatEven(d, quarter(3), quarter(2));
    const VI front = ConcatEven(d, high, low);
    const auto here = has_row(row, count);
    nearest = Min(nearest, IfThenElse(here, front, nearest));
    farthest = Max(farthest, IfThenElse(here, front, farthest));
    // These are the fronts, until the sorted slots replace them; values beyond a list's end are not used.
    StoreU(front, d, slots + row * lanes);
  }
  const PackedKeys packed(nearest, farthest, rows);
  float* keys = order.keys.data();
  for (std::size_t row = 0; row < rows; ++row) {
    VI key = packed.behind_all(row);
    if (row < most) key = IfThenElse(has_row(row, count), packed.pack(LoadU(d, slots + row * lanes), row), key);
    StoreU(BitCast(df, key), df, keys + row * lanes);
  }
  sort_lanes(keys, static_cast<int>(chunks));
  const VI bytes = Set(d, static_cast<std::int32_t>(stride * sizeof *list));
  auto ties = count < Zero(d);
  VI previous = Zero(d);
  for (std::size_t row = 0; row < most; ++row) {
    const VI key = BitCast(d, LoadU(df, keys + row * lanes));
    StoreU(packed.row(key) * bytes, d, slots + row * lanes);
    ties = Or(ties, packed.level(previous, key));
    previous = key;
  }
  if (!AllFalse(d, ties)) {
    for (unsigned left = lane_bits(ties); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
      settle_ties(lists.of_lane(lane), counts[lane], lanes, slots + lane);
    }
  }
  return most;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::sorting
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
