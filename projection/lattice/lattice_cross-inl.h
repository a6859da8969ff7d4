// SPDX-License-Identifier: BSD-3-Clause
// Computes where rays pass through a cell: turns a queue of hits into segments, one hit per lane; the hits may belong
// to any cell of the batch. Included once per instruction set (Highway's include guard idiom).
//
// What      The signs of the inner edge functions E (lattice_shapes-inl.h) select the two faces that a ray passes:
//             two and two     face 0 or 1 by the sign of E_1, face 2 or 3 by the sign of E_2;
//             one and three   face 0, and one of the three: face 1 where E_0 and E_1 are positive, else face 2 or 3 by
//                             the sign of E_2.
//           A face is a plane over the square's pixels: depth = start + x d_x + y d_y, scalar and weight in the same
//           way, with (x, y) the pixel relative to the square's centre. The nearer of the two depths is the segment's
//           front.
// How       Columns and rows are 16-bit halves of one integer, and so are gradients, so that a pair of products is one
//           instruction (dot_of_halves); the upper 16 bits of a gradient take a second instruction. Under perspective,
//           the planes are those of 1 / w and q / w, relative to corner c of the face: q = q_c + plane / weight.
// Bits      Only integers, and float operations within a lane, are used: cells with a common face compute the same bits
//           there.
// Ends      If a float does not determine a sign with certainty, the exact sign is computed out of line (30 hits in a
//           million).

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

/// Adds pairs of 16-bit integers.
HWY_INLINE VI add_pairs(VI a, VI b) {
  const hn::Repartition<std::int16_t, DI> pairs;
  return BitCast(DI(), BitCast(pairs, a) + BitCast(pairs, b));
}

#if HWY_TARGET <= HWY_AVX2
/// One flag for each of as many cells as there are lanes; lanes can look up the flag of any of these cells.
struct CellFlags {
  VI three, behind;
  HWY_INLINE CellFlags(const CellParts& parts, int from)
      : three(Set(DI(), static_cast<std::int32_t>(parts.three >> from))),
        behind(Set(DI(), static_cast<std::int32_t>(parts.behind >> from))) {}
};

/// Provides, for each hit, the values of its cell. With N lanes, hits may belong to N cells from cell `from` on. One
/// vector has one value of all these cells, and is permuted to give each hit its cell's value; with AVX-512, one
/// permutation selects from two vectors.
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
  /// Selects the second of two values.
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

/// Provides the same values if all hits belong to one cell.
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
                         const MaskedRect& pixels, SegmentStream& out, RasterCounts& counts)
      : view_(view), batch_(batch), parts_(parts), pixels_(pixels), out_(out), counts_(counts) {
    const scene::PixelRect rect = pixels.in_square();
    pixel_step_ = Set(DI(), rect.width() << 16 | 1);
    center_pixel_ = Set(DI(), (CellBatch::center - rect.y0) * rect.width() + CellBatch::center - rect.x0);
  }

  /// Whether hits of as many cells as there are lanes can be processed together. This requires that lanes can get their
  /// cells' values by permuting.
  static constexpr bool together = lanes >= 8;

#if HWY_TARGET <= HWY_AVX2
  /// Processes hits of the cells from `from` on as long as they fill all lanes; the remaining hits stay in the queue.
  /// `two`, `three`: the shapes that the cells may have.
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
  /// Processes the remaining hits, too.
  template <bool two, bool three>
  HWY_INLINE void finish(HitQueue& queue, int from) {
    drain<two, three>(queue, from);
    const CellFlags flags(parts_, from);
    if (queue.size > 0) cross(queue.hit, queue.size, AnyCell<two, three>(flags, from, Load(DI(), queue.hit)));
    queue.size = 0;
  }
#endif
  /// Processes the hits that a cell has added. If hits of all cells are processed together, they may stay in the queue
  /// until finish_cells().
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

  /// Appends the segments of `count` hits; `cells` provides the values of their cells.
  template <class Cells>
  HWY_INLINE void cross(const std::int32_t* hits, std::size_t count, const Cells& cells) {
    const DI d;
    const DF df;
    const VI hit = LoadU(d, hits);
    const VI place = place_of(hit);
    InnerEdges inner = inner_edges(hit, place, count, cells);
    // A copy, because settle() changes it in memory: so the original stays in registers.
    const bool settled = HWY_UNLIKELY(!AllFalse(df, inner.uncertain));
    if (settled) {
      InnerEdges exact = inner;
      settle(lane_bits(inner.uncertain), hits, exact);
      inner = exact;
    }

    const PassedFaces<Cells> faces(cells, inner.edge);
    const Crossing first = crossing([&](const CellParts::ByFace& n) HWY_ATTR { return faces.first(n); }, place, cells);
    Crossing second = crossing([&](const CellParts::ByFace& n) HWY_ATTR { return faces.second(n); }, place, cells);
    // A ray that only touches the cell has no distance inside it.
    if (settled) second.depth = IfThenElse(RebindMask(d, inner.touching), first.depth, second.depth);
    const MF swapped = RebindMask(df, cells.behind());
    const SegmentLanes segments{Min(first.depth, second.depth), Max(first.depth, second.depth),
                                IfThenElse(swapped, second.scalar, first.scalar),
                                IfThenElse(swapped, first.scalar, second.scalar)};
    const VI pixel = dot_of_halves(place, pixel_step_) + center_pixel_;
    if (settled) {
      if (HWY_UNLIKELY(out_.keeps_hits)) append_hits(inner.hits_cell, hit, out_);
      append(inner.hits_cell, pixel, segments, out_);
    } else {
      append_all(count, hit, pixel, segments);
    }
  }

  /// Returns column and row of hits relative to the square's centre, 16 bits each.
  static HWY_INLINE VI place_of(VI hit) {
    const auto number = [](int n) HWY_ATTR { return Set(DI(), n); };
    constexpr std::int32_t side_pair = (SegmentWindows::side - 1) * 0x10001;
    constexpr std::int32_t minus_center_pair = -CellBatch::center * 0x10000 | (-CellBatch::center & 0xffff);
    return add_pairs(And(ShiftRight<Hit::column_bit>(hit), number(side_pair)), number(minus_center_pair));
  }

  /// The inner edge functions at hits, and which of the hits are confirmed.
  struct InnerEdges {
    VF edge[3];              ///< as in CellParts::inner; the first is zero if no cell has three inner edges
    MF uncertain;            ///< lanes where a float does not determine a sign with certainty
    MF hits_cell, touching;  ///< set by settle(); before that, `hits_cell` contains all lanes with a hit
  };
  template <class Cells>
  HWY_INLINE InnerEdges inner_edges(VI hit, VI place, std::size_t count, const Cells& cells) const {
    const DI d;
    const DF df;
    const VF x = ConvertTo(df, ShiftRight<16>(ShiftLeft<16>(place))), y = ConvertTo(df, ShiftRight<16>(place));
    const auto at_pixel = [&](const CellParts::Edge& edge) HWY_ATTR {
      return MulAdd(cells.number(edge.x), x, MulAdd(cells.number(edge.y), y, cells.number(edge.start)));
    };
    InnerEdges inner;
    inner.edge[0] = Zero(df), inner.edge[1] = at_pixel(parts_.inner[1]), inner.edge[2] = at_pixel(parts_.inner[2]);
    VF least = least_magnitude(inner.edge[1], inner.edge[2]);
    if constexpr (Cells::may_be_three) {
      inner.edge[0] = at_pixel(parts_.inner[0]);
      least = least_magnitude(least, inner.edge[0]);
    }
    inner.hits_cell = inner.touching = FirstN(df, count);
    const MF flagged = RebindMask(df, TestBit(hit, Set(d, Hit::uncertain)));
    inner.uncertain = And(inner.hits_cell, Or(least <= Set(df, 1.0f), flagged));
    return inner;
  }

  /// The two faces that the lanes' rays pass, as positions in Roles::face.
  template <class Cells>
  class PassedFaces {
   public:
    HWY_INLINE PassedFaces(const Cells& cells, const VF (&inner)[3])
        : cells_(cells),
          first_of_two_(cells.choice(second_of_two(cells, inner))),
          last_(cells.choice(RebindMask(DI(), inner[2] <= Zero(DF())))),
          first_of_three_(RebindMask(DI(), And(inner[0] > Zero(DF()), inner[1] > Zero(DF())))) {}

    /// Returns the front face's value, or that of the single face against three.
    HWY_INLINE VI first(const CellParts::ByFace& numbers) const {
      if constexpr (!Cells::may_be_two)
        return cells_.number(numbers[0]);
      else
        return cells_.number(numbers[0], numbers[1], first_of_two_);
    }
    /// Returns the back face's value, or that of the face, among the three, that the inner edges select.
    HWY_INLINE VI second(const CellParts::ByFace& numbers) const {
      const VI others = cells_.number(numbers[2], numbers[3], last_);
      if constexpr (!Cells::may_be_three) return others;
      return IfThenElse(first_of_three_, cells_.number(numbers[1]), others);
    }

   private:
    static HWY_INLINE MI second_of_two(const Cells& cells, const VF (&inner)[3]) {
      const MI second = RebindMask(DI(), inner[1] <= Zero(DF()));
      if constexpr (Cells::may_be_three && Cells::may_be_two) return AndNot(cells.three(), second);
      return second;
    }

    const Cells& cells_;
    typename Cells::Choice first_of_two_, last_;
    MI first_of_three_;
  };

  /// Depth (in steps) and scalar where the lanes' rays pass one side of the cell.
  struct Crossing {
    VI depth;
    VF scalar;
  };
  /// `of_face(values)` returns, in every lane, the value of the face that the lane's ray passes.
  template <class OfFace, class Cells>
  HWY_INLINE Crossing crossing(const OfFace& of_face, VI place, const Cells& cells) const {
    const DF df;
    const auto at_pixel = [&](const CellParts::Planes& planes) HWY_ATTR {
      return of_face(planes.start) + dot_of_halves(of_face(planes.low), place) +
             ShiftLeft<16>(dot_of_halves(of_face(planes.high), place));
    };
    Crossing c;
    c.depth = at_pixel(parts_.depth);
    if constexpr (per_cell)
      c.scalar = cells.number(batch_.cell_scalar);
    else
      c.scalar = ConvertTo(df, at_pixel(parts_.scalar));
    if constexpr (perspective) {
      const VF inverse = inverse_weight(at_pixel(parts_.weight));
      c.depth = NearestInt(ConvertTo(df, c.depth) * inverse) + of_face(parts_.depth_c);
      if constexpr (!per_cell) c.scalar = MulAdd(c.scalar, inverse, BitCast(df, of_face(parts_.scalar_c)));
    }
    return c;
  }

  /// Returns 1 / weight from the integer value of a plane.
  static HWY_INLINE VF inverse_weight(VI weight) {
    const DF d;
    const VF w = ConvertTo(d, weight);
    // One Newton step improves the estimate (11 to 14 bits) to the accuracy of a float.
    const VF estimate = ApproximateReciprocal(w);
    return estimate * NegMulAdd(w, estimate, Set(d, 2.0f)) * Set(d, CellBatch::weight_one);
  }

  /// Appends the first `count` lanes.
  HWY_INLINE void append_all(std::size_t count, VI hit, VI pixel, const SegmentLanes& segments) {
    const DI d;
    const DF df;
    // `size` is read before the first store, because a compiler must assume that any of the stores could change it.
    const std::size_t at = out_.size;
    std::int32_t *const pixels = out_.pixel.data(), *const fronts = out_.front.data(), *const backs = out_.back.data();
    float *const scalar_fronts = out_.scalar_front.data(), *const scalar_backs = out_.scalar_back.data();
    StoreU(pixel, d, pixels + at);
    StoreU(segments.front, d, fronts + at), StoreU(segments.back, d, backs + at);
    StoreU(segments.scalar_front, df, scalar_fronts + at), StoreU(segments.scalar_back, df, scalar_backs + at);
    if (HWY_UNLIKELY(out_.keeps_hits)) StoreU(hit, d, out_.hit.data() + at);
    out_.size = at + count;
  }

  /// Determines exact signs for the uncertain lanes.
  HWY_NOINLINE void settle(unsigned uncertain, const std::int32_t* hits, InnerEdges& inner) {
    const DF df;
    alignas(64) float inners[3][lanes], hit[lanes], touches[lanes] = {};
    for (int k = 0; k < 3; ++k) Store(inner.edge[k], df, inners[k]);
    Store(IfThenElseZero(inner.hits_cell, Set(df, 1.0f)), df, hit);
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
        touches[lane] = static_cast<float>(settle_pixel(
            view_, batch_, t, {pixels_.square_x() + column + 0.5, pixels_.square_y() + row + 0.5}, edge, counts_));
      hit[lane] = outline() > 0 ? 1.0f : 0.0f;
      if (roles.three != 0) inners[0][lane] = edge[roles.inner[0]];
      inners[1][lane] = edge[roles.three != 0 ? roles.inner[1] : roles.inner[0]];
      inners[2][lane] = edge[roles.three != 0 ? roles.inner[2] : roles.inner[1]];
    }
    for (int k = 0; k < 3; ++k) inner.edge[k] = Load(df, inners[k]);
    inner.hits_cell = Load(df, hit) > Zero(df);
    inner.touching = Load(df, touches) > Zero(df);
  }

  const LatticeView& view_;
  const CellBatch& batch_;
  const CellParts& parts_;
  const MaskedRect& pixels_;
  SegmentStream& out_;
  RasterCounts& counts_;
  VI pixel_step_, center_pixel_;  ///< number of pixels in a row, and 1, in 16 bits each; the pixel of column and row 0
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
