// SPDX-License-Identifier: BSD-3-Clause
// Access to a LaneTable from float lanes. Included once per instruction set (Highway's include guard idiom).
//
// What      Finds the interval of the transfer function that contains each lane's scalar, and the table's numbers for
//           this interval.
// How       Columns of few knots are kept in one or two vectors, and a permutation looks up all lanes. Longer columns
//           stay in memory. Usually two vectors around the first lane's interval contain the entries of all lanes;
//           otherwise the entries are gathered. Intervals are found by a uniform grid, or by comparing some knots,
//           followed by a binary search.
// Bits      All forms of the table give the same results.

#if defined(TESSERA_INTEGRALS_LANE_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_INTEGRALS_LANE_LOOKUP_INL_H_
#undef TESSERA_INTEGRALS_LANE_LOOKUP_INL_H_
#else
#define TESSERA_INTEGRALS_LANE_LOOKUP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <bit>

#include "integrals/lane_table.hpp"
#include "scene/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using scene::HWY_NAMESPACE::DF;
using scene::HWY_NAMESPACE::DI;
using scene::HWY_NAMESPACE::lookup_two;
using scene::HWY_NAMESPACE::MF;
using scene::HWY_NAMESPACE::truncated;
using scene::HWY_NAMESPACE::VF;
using scene::HWY_NAMESPACE::VI;

/// Where the table's rows are stored: each row in one vector, each in two vectors, or in memory.
enum class TableForm { one_vector, two_vectors, many };

HWY_INLINE TableForm form_of(const LaneTable& table) {
  const std::size_t edges = table.knot_count + 2, lanes = hn::Lanes(DF());
  return edges <= lanes ? TableForm::one_vector : edges <= 2 * lanes ? TableForm::two_vectors : TableForm::many;
}

/// Looks up intervals for each lane. Every form provides:
///   locate(s, up)    the interval that a ray at s enters: the number of knots at or below s where `up` is set, else of
///                    those below s;
///   index(i, active) the intervals prepared for lookups; only those of active lanes need to be valid;
///   at(column, index)  the table's numbers in these intervals;
///   edge(i, index, upper)  an end of each interval: the upper end where `upper` is 1 or true;
///   most_pieces      upper bound of the number of pieces of a segment.
template <TableForm form>
class Lookup;

/// Adds one to `count` in lanes of the mask.
HWY_INLINE VI count_if(MF mask, VI count) {
  const DI di;
#if HWY_TARGET <= HWY_AVX3
  return IfThenElse(RebindMask(di, mask), count + Set(di, 1), count);
#else
  return count - VecFromMask(di, RebindMask(di, mask));
#endif
}

/// Returns the next float above s in lanes of `up`, else s. A knot is less than the next float if it is at or below s,
/// so one comparison serves both directions.
HWY_INLINE VF past(VF s, MF up) {
  const DF d;
  const DI di;
  const VI bits = BitCast(di, s + Zero(d));  // the bit pattern of -0 has no neighbouring float
  const VI away = Or(ShiftRight<31>(bits), Set(di, 1));
  return BitCast(d, IfThenElse(RebindMask(di, up), bits + away, bits));
}

/// Adds to `passed` the number of further knots below s, by a binary search of the edges. edge_at(i) must return
/// edge[i].
template <class EdgeAt>
HWY_INLINE VI search(VI passed, std::size_t first_step, VF s, const EdgeAt& edge_at) {
  const DI di;
  for (std::size_t step = first_step; step > 0; step /= 2) {
    const VI further = passed + Set(di, static_cast<std::int32_t>(step));
    passed = IfThenElse(RebindMask(di, edge_at(further) < s), further, passed);
  }
  return passed;
}

/// Up to eight knots, evenly spaced by index. Comparing all of them is faster than the first steps of a search.
struct Landmarks {
  static constexpr std::size_t count = 8;
  explicit HWY_INLINE Landmarks(const LaneTable& table) {
    const std::size_t stride = std::bit_ceil((table.knot_count + count - 1) / count);
    for (std::size_t i = 0; i < count; ++i)
      value[i] = table.column(LaneTable::edge)[std::min((i + 1) * stride, table.knot_count + 1)];
    stride_bits = std::countr_zero(stride);
    first_step = stride / 2;
  }
  HWY_INLINE VI passed(VF s) const {
    const DF d;
    VI even = Zero(DI()), odd = even;
    for (std::size_t i = 0; i < count; i += 2) {
      even = count_if(Set(d, value[i]) < s, even);
      odd = count_if(Set(d, value[i + 1]) < s, odd);
    }
    const VI landmarks = even + odd;
    return first_step > 0 ? ShiftLeftSame(landmarks, stride_bits) : landmarks;
  }
  float value[count];
  int stride_bits;
  std::size_t first_step;  ///< first step of the search between two landmarks
};

template <>
class Lookup<TableForm::one_vector> {
 public:
  using Index = hn::Vec<DI>;
  explicit HWY_INLINE Lookup(const LaneTable& table)
      : independent(table.emission == scene::Emission::independent),
        has_clear(table.has_clear),
        most_pieces(table.knot_count + 2),
        landmarks_(table) {
    const DF d;
    const DI di;
    for (int c = 0; c < LaneTable::column_count; ++c) rows_[c] = LoadU(d, table.column(c));
    // A grid of few cells with at most one knot per cell is also kept in registers; it takes half the work of comparing
    // knots.
    const std::size_t lanes = hn::Lanes(di), cells = table.knots_before.size();
    in_registers_ = cells <= 2 * lanes && table.largest_step <= 1;
    if (!in_registers_) return;
    HWY_ALIGN std::int32_t before[2 * MaxLanes(DI())] = {};
    std::copy(table.knots_before.begin(), table.knots_before.end(), before);
    low_cells_ = BitCast(d, Load(di, before)), high_cells_ = BitCast(d, Load(di, before + lanes));
    grid_origin_ = Set(d, table.grid_origin), grid_scale_ = Set(d, table.grid_scale);
    last_cell_ = Set(d, table.last_cell);
  }
  HWY_INLINE VI locate(VF s, MF up) const {
    const DF d;
    const DI di;
    if (HWY_LIKELY(in_registers_)) {
      const VF place = (s - grid_origin_) * grid_scale_;
      const VI cell = truncated(Min(Max(place, Zero(d)), last_cell_));
      const VI before = BitCast(di, lookup_two(low_cells_, high_cells_, cell));
      const VF next = at(LaneTable::edge, before + Set(di, 1));
      return count_if(Or(next < s, And(up, next == s)), before);
    }
    const VF passing = past(s, up);
    return search(landmarks_.passed(passing), landmarks_.first_step, passing,
                  [&](VI i) HWY_ATTR { return at(LaneTable::edge, i); });
  }
  HWY_INLINE Index index(VI interval, MF) const { return interval; }
  HWY_INLINE VF at(int column, const Index& i) const {
    return TableLookupLanes(rows_[column], IndicesFromVec(DF(), i));
  }
  HWY_INLINE VF edge(VI, const Index& i, VI upper) const { return at(LaneTable::edge, i + upper); }
  HWY_INLINE VF edge(VI, const Index& i, MF upper) const { return at(LaneTable::edge, count_if(upper, i)); }

  bool independent, has_clear;
  std::size_t most_pieces;

 private:
  Landmarks landmarks_;
  VF rows_[LaneTable::column_count];
  bool in_registers_;
  VF low_cells_, high_cells_;  ///< number of knots in all lower cells, stored as the bits of floats
  VF grid_origin_, grid_scale_, last_cell_;
};

template <>
class Lookup<TableForm::two_vectors> {
 public:
  using Index = hn::Vec<DI>;
  explicit HWY_INLINE Lookup(const LaneTable& table)
      : independent(table.emission == scene::Emission::independent),
        has_clear(table.has_clear),
        most_pieces(table.knot_count + 2),
        landmarks_(table) {
    const DF d;
    for (int c = 0; c < LaneTable::column_count; ++c) {
      low_[c] = LoadU(d, table.column(c));
      high_[c] = LoadU(d, table.column(c) + hn::Lanes(d));
    }
  }
  HWY_INLINE VI locate(VF s, MF up) const {
    s = past(s, up);
    return search(landmarks_.passed(s), landmarks_.first_step, s,
                  [&](VI i) HWY_ATTR { return at(LaneTable::edge, i); });
  }
  HWY_INLINE Index index(VI interval, MF) const { return interval; }
  HWY_INLINE VF at(int column, const Index& i) const { return lookup_two(low_[column], high_[column], i); }
  HWY_INLINE VF edge(VI, const Index& i, VI upper) const { return at(LaneTable::edge, i + upper); }
  HWY_INLINE VF edge(VI, const Index& i, MF upper) const { return at(LaneTable::edge, count_if(upper, i)); }

  bool independent, has_clear;
  std::size_t most_pieces;

 private:
  Landmarks landmarks_;
  VF low_[LaneTable::column_count], high_[LaneTable::column_count];
};

/// Neighbouring lanes are usually in neighbouring intervals. A window of two vectors around the first active lane's
/// interval then contains the intervals of all lanes, and two loads and a permutation replace a gather. The numbers are
/// the same.
template <>
class Lookup<TableForm::many> {
 public:
  struct Index {
    VI interval, in_window;
    std::size_t window;
    bool windowed;
  };
  explicit HWY_INLINE Lookup(const LaneTable& table)
      : independent(table.emission == scene::Emission::independent),
        has_clear(table.has_clear),
        most_pieces(table.knot_count + 2),
        table_(table) {}
  HWY_INLINE VI locate(VF s, MF up) const {
    const DF d;
    const DI di;
    const VF place = (s - Set(d, table_.grid_origin)) * Set(d, table_.grid_scale);
    const VI cell = truncated(Min(Max(place, Zero(d)), Set(d, table_.last_cell)));
    return search(GatherIndex(di, table_.knots_before.data(), cell), table_.largest_step, past(s, up),
                  [&](VI i) HWY_ATTR { return GatherIndex(DF(), table_.column(LaneTable::edge), i); });
  }
  HWY_INLINE Index index(VI interval, MF active) const {
    const DF d;
    const DI di;
    constexpr std::size_t most = MaxLanes(DF());
    HWY_ALIGN std::int32_t intervals[most];
    Store(interval, di, intervals);
    const auto lanes = static_cast<std::int32_t>(hn::Lanes(di));
    const auto first = std::max<std::intptr_t>(0, FindFirstTrue(d, active));
    const std::int32_t window = std::max(0, intervals[first] - lanes);
    Index index;
    index.interval = interval;
    index.window = static_cast<std::size_t>(window);
    const VI in_window = interval - Set(di, window);
    // A lane may be outside the window on either side. The last element is reserved for the upper edge of an interval.
    const auto outside = RebindMask(d, Or(in_window<Zero(di), in_window> Set(di, 2 * lanes - 2)));
    index.windowed = AllFalse(d, And(active, outside));
    index.in_window = IfThenZeroElse(RebindMask(di, outside), in_window);
    return index;
  }
  HWY_INLINE VF at(int column, const Index& i) const { return look_up(column, i, i.interval, i.in_window); }
  HWY_INLINE VF edge(VI interval, const Index& i, VI upper) const {
    return look_up(LaneTable::edge, i, interval + upper, i.in_window + upper);
  }
  HWY_INLINE VF edge(VI interval, const Index& i, MF upper) const {
    return look_up(LaneTable::edge, i, count_if(upper, interval), count_if(upper, i.in_window));
  }

  bool independent, has_clear;
  std::size_t most_pieces;

 private:
  HWY_INLINE VF look_up(int column, const Index& i, VI interval, VI in_window) const {
    const DF d;
    const float* const row = table_.column(column);
    if (HWY_LIKELY(i.windowed)) {
      const float* const window = row + i.window;
      return lookup_two(LoadU(d, window), LoadU(d, window + hn::Lanes(d)), in_window);
    }
    return GatherIndex(d, row, interval);
  }

  const LaneTable& table_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#endif
