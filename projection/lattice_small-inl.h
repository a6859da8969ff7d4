// Small cells of the lattice rasterizer, a cell a lane; included once per instruction set (Highway's include guard
// idiom).

#if defined(TESSERA_PROJECTION_LATTICE_SMALL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_SMALL_INL_H_
#undef TESSERA_PROJECTION_LATTICE_SMALL_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_SMALL_INL_H_
#endif

#include <hwy/highway.h>

#include <utility>

#include "projection/lattice_shapes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// The order in which SmallCells keeps cells' edges and faces: [slot][front faces].
struct SmallOrder {
  /// Two faces against two: the outline's four edges, the front faces' edge, the back faces'. One against three: the
  /// outline's three, edges 01, 02, 12 of the three.
  alignas(64) std::int32_t edge[6][16];
  alignas(64) std::int32_t face[4][16];                   ///< Roles::face
  alignas(64) std::int32_t three[16], single_behind[16];  ///< 1 or 0; the latter of three only
};
constexpr SmallOrder make_small_order() {
  SmallOrder o{};
  for (unsigned front = 0; front < 16; ++front) {
    const Roles r = role_table.roles[front];
    for (int k = 0; k < 3; ++k) o.edge[k][front] = r.outline[k];
    o.edge[3][front] = r.three ? r.inner[0] : r.outline[3];
    o.edge[4][front] = r.three ? r.inner[1] : r.inner[0];
    o.edge[5][front] = r.three ? r.inner[2] : r.inner[1];
    for (int k = 0; k < 4; ++k) o.face[k][front] = r.face[k];
    o.three[front] = r.three, o.single_behind[front] = r.three && r.single_behind;
  }
  return o;
}
constexpr SmallOrder small_order = make_small_order();

/// Whether some valid cell has `what` in a slot.
constexpr bool occurs(const std::int32_t (&slot)[16], std::int32_t what) {
  for (unsigned front = 0; front < 16; ++front)
    if (role_table.roles[front].valid && slot[front] == what) return true;
  return false;
}

/// Cells of a few pixels, whose blocks would be mostly empty and cost less than what is prepared for them: all lanes'
/// cells together go through their candidate pixels, row by row, each from its own corner. The numbers and their
/// rounding are those of CellRaster.
template <bool perspective, bool per_cell>
class SmallCells {
 public:
  /// Those of `cells` (a bit each, from the batch's cell `from` on) that are faster this way: up to some size, if the
  /// most candidate pixels of them all cost less than their blocks.
  HWY_INLINE static unsigned worth_while(const CellBatch& batch, int from, unsigned cells) {
    const I d;
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(cells), static_cast<std::uint8_t>(cells >> 8)};
    const auto takes = hn::LoadMaskBits(d, bits);
    const VI width = hn::IfThenElseZero(takes, hn::Sub(hn::Load(d, batch.x1 + from), hn::Load(d, batch.x0 + from)));
    const VI height = hn::IfThenElseZero(takes, hn::Sub(hn::Load(d, batch.y1 + from), hn::Load(d, batch.y0 + from)));
    const VI side = hn::Max(width, height), three = hn::Set(d, 3);
    const VI blocks = hn::Mul(hn::ShiftRight<2>(hn::Add(width, three)), hn::ShiftRight<2>(hn::Add(height, three)));
    const VI cost = hn::IfThenElseZero(takes, hn::Add(hn::Mul(blocks, hn::Set(d, block_cost)), hn::Set(d, cell_cost)));
    for (const int most_side : {12, 6, 4}) {
      const auto small = hn::Lt(side, hn::Set(d, most_side + 1));
      const int candidates = hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(small, width))) *
                             hn::GetLane(hn::MaxOfLanes(d, hn::IfThenElseZero(small, height)));
      if (candidates * step_cost + start_cost < hn::GetLane(hn::SumOfLanes(d, hn::IfThenElseZero(small, cost))))
        return cells & lane_bits(hn::RebindMask(F(), small));
    }
    return 0;
  }

  /// The lanes are the batch's cells from, from + 1...; those of `cells` (a bit each) are rasterized.
  HWY_INLINE SmallCells(const LatticeView& view, const CellBatch& batch, int from, unsigned cells)
      : view_(view), batch_(batch), from_(from) {
    const I d;
    const F df;
    const VI front = hn::And(hn::BitCast(d, hn::Load(hn::RebindToUnsigned<I>(), batch.bits + from)), hn::Set(d, 15));
    const std::uint8_t bits[8] = {static_cast<std::uint8_t>(cells), static_cast<std::uint8_t>(cells >> 8)};
    const auto takes = hn::LoadMaskBits(d, bits);
    const VI x0 = hn::Load(d, batch.x0 + from), y0 = hn::Load(d, batch.y0 + from);
    hn::Store(x0, d, x0_), hn::Store(y0, d, y0_);
    hn::Store(hn::IfThenElseZero(takes, hn::Sub(hn::Load(d, batch.x1 + from), x0)), d, width_);
    hn::Store(hn::IfThenElseZero(takes, hn::Sub(hn::Load(d, batch.y1 + from), y0)), d, height_);
    hn::Store(by_front(small_order.three, front), d, three_);
    hn::Store(by_front(small_order.single_behind, front), d, single_behind_);
    take_edge<0>(front), take_edge<1>(front), take_edge<2>(front);
    take_edge<3>(front), take_edge<4>(front), take_edge<5>(front);
    VI face[4];
    for (int k = 0; k < 4; ++k) face[k] = by_front(small_order.face[k], front);
    const auto take = [&](const std::int32_t(*all)[CellBatch::most], Planes& to) HWY_ATTR {
      VI f[4];
      for (int i = 0; i < 4; ++i) f[i] = hn::Load(d, all[i] + from);
      for (int k = 0; k < 4; ++k) {
        VI v = f[0];
        for (int i = 1; i < 4; ++i) v = hn::IfThenElse(hn::Eq(face[k], hn::Set(d, i)), f[i], v);
        to.face[k] = v;
      }
    };
    const auto take_planes = [&](const CellBatch::FacePlanes& all, Planes& start, Planes& x, Planes& y)
                                 HWY_ATTR { take(all.start, start), take(all.x, x), take(all.y, y); };
    take_planes(batch.depth, depth_, depth_x_, depth_y_);
    if constexpr (!per_cell) take_planes(batch.scalar, scalar_, scalar_x_, scalar_y_);
    if constexpr (perspective) {
      take_planes(batch.weight, weight_, weight_x_, weight_y_);
      take(batch.depth_c, depth_c_);
      if constexpr (!per_cell)
        take(reinterpret_cast<const std::int32_t(*)[CellBatch::most]>(batch.scalar_c), scalar_c_);
    }
  }

  HWY_INLINE void run(const PixelRect& rect, const PixelRect& square, SegmentStream& out, RasterCounts& counts) const {
    const I d;
    const F df;
    const VF zero = hn::Zero(df), one = hn::Set(df, 1.0f);
    const VI width = hn::Load(d, width_), height = hn::Load(d, height_), x0 = hn::Load(d, x0_), y0 = hn::Load(d, y0_);
    const int rows = hn::GetLane(hn::MaxOfLanes(d, height));
    const auto is = [&](const std::int32_t* flags)
                        HWY_ATTR { return hn::RebindMask(df, hn::Ne(hn::Load(d, flags), hn::Zero(d))); };
    const MF three = is(three_), two = hn::Not(three);
    const VI first_pixel = hn::Add(hn::Mul(hn::Sub(y0, hn::Set(d, rect.y0 - square.y0)), hn::Set(d, rect.width())),
                                   hn::Sub(x0, hn::Set(d, rect.x0 - square.x0)));
    const VI from_x = hn::Sub(x0, hn::Set(d, CellBatch::center)), from_y = hn::Sub(y0, hn::Set(d, CellBatch::center));
    const VF first_x = hn::ConvertTo(df, from_x);
    Planes depth_row = depth_, scalar_row = scalar_, weight_row = weight_;
    go(depth_x_, from_x, depth_y_, from_y, depth_row);
    if constexpr (!per_cell) go(scalar_x_, from_x, scalar_y_, from_y, scalar_row);
    if constexpr (perspective) go(weight_x_, from_x, weight_y_, from_y, weight_row);
    for (int r = 0; r < rows; ++r) {
      const auto in_row = hn::Gt(height, hn::Set(d, r));
      const VI row_width = hn::IfThenElseZero(in_row, width);
      const int columns = hn::GetLane(hn::MaxOfLanes(d, row_width));
      const VF y = hn::ConvertTo(df, hn::Add(from_y, hn::Set(d, r)));
      VF row_edge[6];
      for (int k = 0; k < 6; ++k) row_edge[k] = hn::MulAdd(hn::Load(df, edge_y_[k]), y, hn::Load(df, edge_[k]));
      Planes depth = depth_row, scalar = scalar_row, weight = weight_row;
      VF x = first_x;
      for (int c = 0; c < columns; ++c) {
        const MF in_box = hn::RebindMask(df, hn::Gt(row_width, hn::Set(d, c)));
        VF edge[6];
        for (int k = 0; k < 6; ++k) edge[k] = hn::MulAdd(hn::Load(df, edge_x_[k]), x, row_edge[k]);
        const auto least_of_outline = [&]() HWY_ATTR {
          const VF least = hn::Min(hn::Min(edge[0], edge[1]), edge[2]);
          return hn::IfThenElse(two, hn::Min(least, edge[3]), least);
        };
        VF least = least_of_outline();
        MF hit = hn::And(in_box, hn::Gt(least, zero));
        VF sure = hn::Min(hn::Min(hn::Abs(edge[0]), hn::Abs(edge[1])), hn::Abs(edge[2]));
        sure = hn::Min(sure, hn::Min(hn::Min(hn::Abs(edge[3]), hn::Abs(edge[4])), hn::Abs(edge[5])));
        const MF uncertain = hn::And(in_box, hn::Le(sure, one));
        MF touching = hn::Lt(zero, zero);
        if (HWY_UNLIKELY(!hn::AllFalse(df, uncertain))) {
          touching =
              settle(lane_bits(hn::And(uncertain, hn::Gt(least, hn::Set(df, -1.0f)))), square, r, c, edge, counts);
          hit = hn::And(in_box, hn::Gt(least_of_outline(), zero));
        }
        if (!hn::AllFalse(df, hit)) {
          // Of one against three the first side is the one face; of the three it is the one on whose side of its edges
          // with the others the ray passes.
          const MF second_of_two = hn::And(two, hn::Le(edge[4], zero));
          const MF first_of_three = hn::And(hn::And(three, hn::Gt(edge[3], zero)), hn::Gt(edge[4], zero));
          const MF middle = hn::Gt(edge[5], zero);
          const auto first_side = [&](const Planes& p) HWY_ATTR {
            return hn::IfThenElse(hn::RebindMask(d, second_of_two), p.face[1], p.face[0]);
          };
          const auto second_side = [&](const Planes& p) HWY_ATTR {
            const VI behind = hn::IfThenElse(hn::RebindMask(d, middle), p.face[2], p.face[3]);
            return hn::IfThenElse(hn::RebindMask(d, first_of_three), p.face[1], behind);
          };
          const Crossing first = crossing(first_side, depth, scalar, weight);
          Crossing second = crossing(second_side, depth, scalar, weight);
          // Nothing lies between the sides where a ray touches.
          if (HWY_UNLIKELY(!hn::AllFalse(df, touching)))
            second.depth = hn::IfThenElse(hn::RebindMask(d, touching), first.depth, second.depth);
          const MF behind = is(single_behind_);
          append(hit, hn::Add(first_pixel, hn::Set(d, r * rect.width() + c)), hn::Min(first.depth, second.depth),
                 hn::Max(first.depth, second.depth), hn::IfThenElse(behind, second.scalar, first.scalar),
                 hn::IfThenElse(behind, first.scalar, second.scalar), out);
        }
        x = hn::Add(x, one);
        advance(depth_x_, depth);
        if constexpr (!per_cell) advance(scalar_x_, scalar);
        if constexpr (perspective) advance(weight_x_, weight);
      }
      advance(depth_y_, depth_row);
      if constexpr (!per_cell) advance(scalar_y_, scalar_row);
      if constexpr (perspective) advance(weight_y_, weight_row);
    }
  }

 private:
  // Cycles, roughly as measured with AVX-512: of CellRaster, and of a step of all lanes here.
  static constexpr int block_cost = 55, cell_cost = 130, step_cost = 75, start_cost = 300;

  /// A number of each face.
  struct Planes {
    VI face[4];
  };
  /// table[front faces], 16 numbers.
  HWY_INLINE static VI by_front(const std::int32_t* table, VI front) {
    if constexpr (lanes == 16)
      return hn::TableLookupLanes(hn::Load(I(), table), hn::IndicesFromVec(I(), front));
    else
      return hn::GatherIndex(I(), table, front);
  }
  template <int slot>
  HWY_INLINE void take_edge(VI front) {
    const F df;
    const VI which = by_front(small_order.edge[slot], front);
    VF start = hn::Zero(df), x = start, y = start;
    take_edges<slot>(which, start, x, y, std::make_integer_sequence<int, 6>());
    hn::Store(start, df, edge_[slot]), hn::Store(x, df, edge_x_[slot]), hn::Store(y, df, edge_y_[slot]);
  }
  template <int slot, int... e>
  HWY_INLINE void take_edges(VI which, VF& start, VF& x, VF& y, std::integer_sequence<int, e...>) {
    (take_if<slot, e>(which, start, x, y), ...);
  }
  template <int slot, int e>
  HWY_INLINE void take_if(VI which, VF& start, VF& x, VF& y) {
    if constexpr (occurs(small_order.edge[slot], e)) {
      const F df;
      const MF is = hn::RebindMask(df, hn::Eq(which, hn::Set(I(), e)));
      start = hn::IfThenElse(is, hn::Load(df, batch_.edge[e] + from_), start);
      x = hn::IfThenElse(is, hn::Load(df, batch_.edge_x[e] + from_), x);
      y = hn::IfThenElse(is, hn::Load(df, batch_.edge_y[e] + from_), y);
    }
  }
  HWY_INLINE static void go(const Planes& along_x, VI x, const Planes& along_y, VI y, Planes& planes) {
    for (int k = 0; k < 4; ++k)
      planes.face[k] = hn::Add(planes.face[k], hn::Add(hn::Mul(along_x.face[k], x), hn::Mul(along_y.face[k], y)));
  }
  HWY_INLINE static void advance(const Planes& steps, Planes& planes) {
    for (int k = 0; k < 4; ++k) planes.face[k] = hn::Add(planes.face[k], steps.face[k]);
  }

  template <class Side>
  HWY_INLINE Crossing crossing(Side side, const Planes& depth, const Planes& scalar, const Planes& weight) const {
    const F df;
    Crossing c;
    c.depth = side(depth);
    if constexpr (per_cell)
      c.scalar = hn::Load(df, batch_.cell_scalar + from_);
    else
      c.scalar = hn::ConvertTo(df, side(scalar));
    if constexpr (perspective) {
      const VF inverse = inverse_weight(side(weight));
      c.depth = hn::Add(hn::NearestInt(hn::Mul(hn::ConvertTo(df, c.depth), inverse)), side(depth_c_));
      if constexpr (!per_cell) c.scalar = hn::MulAdd(c.scalar, inverse, hn::BitCast(df, side(scalar_c_)));
    }
    return c;
  }

  /// Exact signs for the lanes of `uncertain` at their pixel (column, row). Returns the lanes whose ray touches.
  HWY_NOINLINE MF settle(unsigned uncertain, const PixelRect& square, int row, int column, VF (&edge)[6],
                         RasterCounts& counts) const {
    const F df;
    alignas(64) float edges[6][lanes], touching[lanes] = {};
    for (int k = 0; k < 6; ++k) hn::Store(edge[k], df, edges[k]);
    for (; uncertain != 0; uncertain &= uncertain - 1) {
      const int l = __builtin_ctz(uncertain), t = from_ + l;
      const unsigned front = batch_.front_faces(t);
      float by_edge[6];
      for (int k = 0; k < 6; ++k) by_edge[small_order.edge[k][front]] = edges[k][l];
      touching[l] = static_cast<float>(settle_pixel(view_, batch_, t, square.x0 + x0_[l] + column + 0.5,
                                                    square.y0 + y0_[l] + row + 0.5, by_edge, 1, counts));
      for (int k = 0; k < 6; ++k) edges[k][l] = by_edge[small_order.edge[k][front]];
    }
    for (int k = 0; k < 6; ++k) edge[k] = hn::Load(df, edges[k]);
    return hn::Gt(hn::Load(df, touching), hn::Zero(df));
  }

  const LatticeView& view_;
  const CellBatch& batch_;
  int from_;
  // A cell a lane; of lanes that are not taken the width is 0 and all else of no account.
  alignas(64) std::int32_t x0_[lanes], y0_[lanes], width_[lanes], height_[lanes];
  alignas(64) std::int32_t three_[lanes], single_behind_[lanes];
  alignas(64) float edge_[6][lanes], edge_x_[6][lanes], edge_y_[6][lanes];
  Planes depth_, depth_x_, depth_y_, scalar_, scalar_x_, scalar_y_, weight_, weight_x_, weight_y_;
  Planes depth_c_, scalar_c_;  ///< the latter floats
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
