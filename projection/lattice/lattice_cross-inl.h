// SPDX-License-Identifier: BSD-3-Clause
// Where rays pass a cell: the segments of a queue of hits, a hit a lane, whichever cell it is of; included once per
// instruction set (Highway's include guard idiom).

#if defined(TESSERA_PROJECTION_LATTICE_CROSS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_CROSS_INL_H_
#undef TESSERA_PROJECTION_LATTICE_CROSS_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_CROSS_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/lattice/lattice_parts-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Pairs of 16 bits, added.
HWY_INLINE VI add_pairs(VI a, VI b) {
  const hn::Repartition<std::int16_t, DI> pairs;
  return BitCast(DI(), BitCast(pairs, a) + BitCast(pairs, b));
}

#if HWY_TARGET <= HWY_AVX2
/// What is true of some of as many cells as there are lanes, for lanes to ask.
struct CellFlags {
  VI three, behind;
  HWY_INLINE CellFlags(const CellParts& parts, int from)
      : three(Set(DI(), static_cast<std::int32_t>(parts.three >> from))),
        behind(Set(DI(), static_cast<std::int32_t>(parts.behind >> from))) {}
};

/// What lanes ask of their hits' cells: whichever each is of, of as many as there are lanes, from `from` on. Their
/// numbers are one vector to permute from; with AVX-512 one permute takes the one or the other of two.
template <bool two, bool with_three>
class AnyCell {
 public:
  static constexpr bool may_be_two = two, may_be_three = with_three;
  HWY_INLINE AnyCell(const CellFlags& flags, int from, VI hit)
      : flags_(flags), from_(from), cell_(And(hit, Set(DI(), lanes - 1))), bit_(Shl(Set(DI(), 1), cell_)) {}
  HWY_INLINE MI three() const { return TestBit(flags_.three, bit_); }
  HWY_INLINE MI behind() const { return TestBit(flags_.behind, bit_); }
  template <class T>
  HWY_INLINE hn::Vec<hn::ScalableTag<T>> number(const T* numbers) const {
    const hn::ScalableTag<T> d;
    return TableLookupLanes(Load(d, numbers + from_), IndicesFromVec(d, cell_));
  }
  /// To choose the second of two numbers.
#if HWY_TARGET <= HWY_AVX3
  using Choice = VI;
  HWY_INLINE Choice choice(MI second) const { return or_where(second, cell_, Set(DI(), CellBatch::most)); }
  HWY_INLINE VI number(const std::int32_t* first, const std::int32_t* second, Choice choice) const {
    return lookup_two(Load(DI(), first), Load(DI(), second), choice);
  }
#else
  using Choice = MI;
  HWY_INLINE Choice choice(MI second) const { return second; }
  HWY_INLINE VI number(const std::int32_t* first, const std::int32_t* second, Choice choice) const {
    return IfThenElse(choice, number(second), number(first));
  }
#endif

 private:
  const CellFlags& flags_;
  int from_;
  VI cell_, bit_;
};
#endif

/// The same where all hits are of one cell.
template <bool is_three>
class OneCell {
 public:
  static constexpr bool may_be_two = !is_three, may_be_three = is_three;
  HWY_INLINE OneCell(const CellParts& parts, int t) : parts_(parts), t_(t) {}
  HWY_INLINE MI behind() const {
    const DI d;
    return Set(d, -static_cast<std::int32_t>(parts_.behind >> t_ & 1)) < Zero(d);
  }
  template <class T>
  HWY_INLINE hn::Vec<hn::ScalableTag<T>> number(const T* numbers) const {
    return Set(hn::ScalableTag<T>(), numbers[t_]);
  }
  using Choice = MI;
  HWY_INLINE Choice choice(MI second) const { return second; }
  HWY_INLINE VI number(const std::int32_t* first, const std::int32_t* second, Choice choice) const {
    return IfThenElse(choice, number(second), number(first));
  }

 private:
  const CellParts& parts_;
  int t_;
};

/// Turns hits into segments, which it appends to `out`.
template <bool perspective, bool per_cell>
class HitCrossing {
 public:
  HWY_INLINE HitCrossing(const LatticeView& view, const CellBatch& batch, const CellParts& parts,
                         const scene::PixelRect& rect, const scene::PixelRect& square, SegmentStream& out,
                         RasterCounts& counts)
      : view_(view),
        batch_(batch),
        parts_(parts),
        square_(square),
        out_(out),
        counts_(counts),
        pixel_step_(Set(DI(), rect.width() << 16 | 1)),
        center_pixel_(Set(DI(), (square.y0 + CellBatch::center - rect.y0) * rect.width() + square.x0 +
                                    CellBatch::center - rect.x0)) {}

  /// Whether hits of as many cells as lanes can be crossed together: where lanes find their cells' numbers by
  /// permuting.
  static constexpr bool together = lanes >= 8;

#if HWY_TARGET <= HWY_AVX2
  /// As many hits of the cells from `from` on as fill lanes; the rest stays. `two`, `three`: the shapes that their
  /// cells may have.
  template <bool two, bool three>
  HWY_INLINE void drain(HitQueue& queue, int from) {
    const DI d;
    const CellFlags flags(parts_, from);
    std::size_t i = 0;
    for (; i + lanes <= queue.size; i += lanes)
      cross(queue.hit + i, lanes, AnyCell<two, three>(flags, from, Load(d, queue.hit + i)));
    Store(Load(d, queue.hit + i), d, queue.hit);
    queue.size -= i;
  }
  /// The rest too.
  template <bool two, bool three>
  HWY_INLINE void finish(HitQueue& queue, int from) {
    drain<two, three>(queue, from);
    const CellFlags flags(parts_, from);
    if (queue.size > 0) cross(queue.hit, queue.size, AnyCell<two, three>(flags, from, Load(DI(), queue.hit)));
    queue.size = 0;
  }
#endif
  /// What a cell has added; where they are crossed all together it waits for others, up to finish_cells().
#if HWY_TARGET <= HWY_AVX3
  HWY_INLINE void drain_cell(HitQueue& queue, int t) {
    if (queue.size < HitQueue::worth_draining) return;
    if ((parts_.three >> t & 1) != 0)
      drain<false, true>(queue, 0);
    else
      drain<true, false>(queue, 0);
  }
  template <bool two, bool three>
  HWY_INLINE void finish_cells(HitQueue& queue) {
    finish<two, three>(queue, 0);
  }
#else
  HWY_INLINE void drain_cell(HitQueue& queue, int t) {
    if ((parts_.three >> t & 1) != 0)
      drain_all(queue, OneCell<true>(parts_, t));
    else
      drain_all(queue, OneCell<false>(parts_, t));
  }
  template <bool two, bool three>
  HWY_INLINE void finish_cells(HitQueue&) {}
#endif

 private:
#if HWY_TARGET > HWY_AVX3
  template <class Cell>
  HWY_INLINE void drain_all(HitQueue& queue, const Cell& cell) {
    for (std::size_t i = 0; i < queue.size; i += lanes)
      cross(queue.hit + i, std::min<std::size_t>(lanes, queue.size - i), cell);
    queue.size = 0;
  }
#endif

  // Long: the two crossings of sixteen hits, whose dozen vectors stay in registers from the first line to the last; a
  // part of it would take nearly all of them as arguments.
  template <class Cells>
  HWY_INLINE void cross(const std::int32_t* hits, std::size_t count, const Cells& cells) {
    const DI d;
    const DF df;
    const auto number = [](int n) HWY_ATTR { return Set(DI(), n); };
    const VI hit = LoadU(d, hits);
    constexpr std::int32_t side_pair = (SegmentWindows::side - 1) * 0x10001;
    constexpr std::int32_t minus_center_pair = -CellBatch::center * 0x10000 | (-CellBatch::center & 0xffff);
    // Column and row from the centre, 16 bits each.
    const VI place = add_pairs(And(ShiftRight<Hit::column_bit>(hit), number(side_pair)), number(minus_center_pair));
    const VF xf = ConvertTo(df, ShiftRight<16>(ShiftLeft<16>(place)));
    const VF yf = ConvertTo(df, ShiftRight<16>(place)), zero = Zero(df);
    const auto inner_at = [&](const CellParts::Edge& edge) HWY_ATTR {
      return MulAdd(cells.number(edge.x), xf, MulAdd(cells.number(edge.y), yf, cells.number(edge.start)));
    };
    VF inner0 = zero, inner1 = inner_at(parts_.inner[1]), inner2 = inner_at(parts_.inner[2]);
    VF sure = least_magnitude(inner1, inner2);
    if constexpr (Cells::may_be_three) {
      inner0 = inner_at(parts_.inner[0]);
      sure = least_magnitude(sure, inner0);
    }
    MF hits_cell = FirstN(df, count), touching = hits_cell;
    const MF flagged = RebindMask(df, TestBit(hit, number(Hit::uncertain)));
    const MF uncertain = And(hits_cell, Or(sure <= Set(df, 1.0f), flagged));
    bool all_hit = true;
    if (HWY_UNLIKELY(!AllFalse(df, uncertain))) {
      Unsettled unsettled{{inner0, inner1, inner2}, hits_cell, touching};  // what settle() changes lies in memory
      settle(lane_bits(uncertain), hits, unsettled);
      inner0 = unsettled.inner[0], inner1 = unsettled.inner[1], inner2 = unsettled.inner[2];
      hits_cell = unsettled.hits_cell, touching = unsettled.touching;
      all_hit = false;
    }

    // Of one face against three the first side is the one face; of the three it is the one on whose side of its edges
    // with the others the ray passes.
    const auto last = cells.choice(RebindMask(d, inner2 <= zero));
    MI second_of_two = RebindMask(d, inner1 <= zero);
    if constexpr (Cells::may_be_three && Cells::may_be_two) second_of_two = AndNot(cells.three(), second_of_two);
    const auto first_choice = cells.choice(second_of_two);
    const auto first_side = [&](const auto& number_of) HWY_ATTR {
      if constexpr (!Cells::may_be_two)
        return cells.number(number_of(0));
      else
        return cells.number(number_of(0), number_of(1), first_choice);
    };
    const MI first_of_three = RebindMask(d, And(inner0 > zero, inner1 > zero));
    const auto second_side = [&](const auto& number_of) HWY_ATTR {
      const VI others = cells.number(number_of(2), number_of(3), last);
      if constexpr (!Cells::may_be_three) return others;
      return IfThenElse(first_of_three, cells.number(number_of(1)), others);
    };
    const auto crossing = [&](const auto& side) HWY_ATTR {
      const auto at_pixel = [&](const CellParts::Planes& planes) HWY_ATTR {
        const VI start = side([&](int k) { return planes[k].start; });
        const VI low = side([&](int k) { return planes[k].low; }), high = side([&](int k) { return planes[k].high; });
        return start + dot_of_halves(low, place) + ShiftLeft<16>(dot_of_halves(high, place));
      };
      Crossing c;
      c.depth = at_pixel(parts_.depth);
      if constexpr (per_cell)
        c.scalar = cells.number(batch_.cell_scalar);
      else
        c.scalar = ConvertTo(df, at_pixel(parts_.scalar));
      if constexpr (perspective) {
        const VF inverse = inverse_weight(at_pixel(parts_.weight));
        const auto numbers_of = [&](const std::int32_t(*all)[CellBatch::most])
                                    HWY_ATTR { return side([&](int k) { return all[k]; }); };
        c.depth = NearestInt(ConvertTo(df, c.depth) * inverse) + numbers_of(parts_.depth_c);
        if constexpr (!per_cell) c.scalar = MulAdd(c.scalar, inverse, BitCast(df, numbers_of(parts_.scalar_c)));
      }
      return c;
    };
    const Crossing first = crossing(first_side);
    Crossing second = crossing(second_side);
    const VI pixel = dot_of_halves(place, pixel_step_) + center_pixel_;
    // Nothing lies between the sides where a ray touches.
    if (HWY_UNLIKELY(!all_hit)) second.depth = IfThenElse(RebindMask(d, touching), first.depth, second.depth);
    const VI front = Min(first.depth, second.depth), back = Max(first.depth, second.depth);
    const MF swapped = RebindMask(df, cells.behind());
    const VF scalar_front = IfThenElse(swapped, second.scalar, first.scalar);
    const VF scalar_back = IfThenElse(swapped, first.scalar, second.scalar);
    if (HWY_UNLIKELY(!all_hit)) {
      if (HWY_UNLIKELY(out_.keeps_hits)) append_hits(hits_cell, hit, out_);
      append(hits_cell, pixel, front, back, scalar_front, scalar_back, out_);
      return;
    }
    // Read before the first store, which might be to any of them as far as a compiler can tell.
    const std::size_t at = out_.size;
    std::int32_t *const pixels = out_.pixel.data(), *const fronts = out_.front.data(), *const backs = out_.back.data();
    float *const scalar_fronts = out_.scalar_front.data(), *const scalar_backs = out_.scalar_back.data();
    StoreU(pixel, d, pixels + at);
    StoreU(front, d, fronts + at), StoreU(back, d, backs + at);
    StoreU(scalar_front, df, scalar_fronts + at), StoreU(scalar_back, df, scalar_backs + at);
    if (HWY_UNLIKELY(out_.keeps_hits)) StoreU(hit, d, out_.hit.data() + at);
    out_.size = at + count;
  }

  struct Unsettled {
    VF inner[3];
    MF hits_cell, touching;
  };
  /// Exact signs for the uncertain lanes.
  HWY_NOINLINE void settle(unsigned uncertain, const std::int32_t* hits, Unsettled& unsettled) {
    const DF df;
    VF(&inner)[3] = unsettled.inner;
    MF &hits_cell = unsettled.hits_cell, &touching = unsettled.touching;
    alignas(64) float inners[3][lanes], hit[lanes], touches[lanes] = {};
    for (int k = 0; k < 3; ++k) Store(inner[k], df, inners[k]);
    Store(IfThenElseZero(hits_cell, Set(df, 1.0f)), df, hit);
    for (; uncertain != 0; uncertain &= uncertain - 1) {
      const int lane = __builtin_ctz(uncertain), t = hits[lane] & (CellBatch::most - 1);
      const int column = hits[lane] >> Hit::column_bit & (SegmentWindows::side - 1);
      const int row = hits[lane] >> Hit::row_bit & (SegmentWindows::side - 1);
      const auto x = static_cast<float>(column - CellBatch::center), y = static_cast<float>(row - CellBatch::center);
      const Roles& roles = role_table.roles[batch_.front_faces(t)];
      float edge[6];
      bool certain = true;
      for (int e = 0; e < 6; ++e) {
        edge[e] = batch_.edge_x[e][t] * x + (batch_.edge_y[e][t] * y + batch_.edge[e][t]);
        certain = certain && std::abs(edge[e]) > 1;
      }
      const auto outline = [&] {
        return std::min(
            {edge[roles.outline[0]], edge[roles.outline[1]], edge[roles.outline[2]], edge[roles.outline[3]]});
      };
      if (outline() > -1 && !certain)
        touches[lane] = static_cast<float>(
            settle_pixel(view_, batch_, t, square_.x0 + column + 0.5, square_.y0 + row + 0.5, edge, 1, counts_));
      hit[lane] = outline() > 0 ? 1.0f : 0.0f;
      if (roles.three != 0) inners[0][lane] = edge[roles.inner[0]];
      inners[1][lane] = edge[roles.three != 0 ? roles.inner[1] : roles.inner[0]];
      inners[2][lane] = edge[roles.three != 0 ? roles.inner[2] : roles.inner[1]];
    }
    for (int k = 0; k < 3; ++k) inner[k] = Load(df, inners[k]);
    hits_cell = Load(df, hit) > Zero(df);
    touching = Load(df, touches) > Zero(df);
  }

  const LatticeView& view_;
  const CellBatch& batch_;
  const CellParts& parts_;
  const scene::PixelRect& square_;
  SegmentStream& out_;
  RasterCounts& counts_;
  VI pixel_step_, center_pixel_;  ///< a row's pixels and one in 16 bits each; of column and row 0
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
