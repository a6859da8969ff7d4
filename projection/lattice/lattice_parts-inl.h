// SPDX-License-Identifier: BSD-3-Clause
// A batch's cells, with their edges and faces in the order of their roles (lattice_shapes-inl.h), so that lanes with
// different cells execute the same code. Included once per instruction set (Highway's include guard idiom).
//
// What   CellParts contains outline, inner edges and face planes by role, one cell per lane. HitQueue is the queue of
//        hits between lattice_cover-inl.h, which finds hits, and lattice_cross-inl.h, which turns them into segments.
// How    The role of an edge or a face follows from the four bits of the front faces. A table of 16 entries contains
//        the edge or face of each role, whose values are then moved to the place of the role.
// Bits   Values are moved, not computed. A face plane's steps are split into 16-bit halves, whose products with a
//        column or row are exact in 32 bits.

#if defined(TESSERA_PROJECTION_LATTICE_PARTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_PARTS_INL_H_
#undef TESSERA_PROJECTION_LATTICE_PARTS_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_PARTS_INL_H_
#endif

#include <hwy/highway.h>

#include <utility>

#include "projection/lattice/lattice_shapes-inl.h"
#include "projection/lattice/segment_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Which edge or face has a role; indexed by [role][front faces].
struct PartTable {
  alignas(64) std::int32_t outline[4][16];  ///< Roles::outline
  /// One face against three: Roles::inner. Two against two: the first is unused, then the edge of the front faces, and
  /// the edge of the back faces.
  alignas(64) std::int32_t inner[3][16];
  alignas(64) std::int32_t face[4][16];                       ///< Roles::face
  alignas(64) std::int32_t three[16], behind[16], valid[16];  ///< 1 or 0; Roles::single_behind, Roles::valid
};
constexpr std::int32_t no_edge = 6;
constexpr PartTable make_part_table() {
  PartTable p{};
  for (unsigned front = 0; front < 16; ++front) {
    const Roles r = role_table.roles[front];
    for (int k = 0; k < 4; ++k) p.outline[k][front] = r.outline[k], p.face[k][front] = r.face[k];
    p.inner[0][front] = r.three ? std::int32_t{r.inner[0]} : no_edge;
    p.inner[1][front] = r.three ? r.inner[1] : r.inner[0];
    p.inner[2][front] = r.three ? r.inner[2] : r.inner[1];
    p.three[front] = r.three, p.behind[front] = r.single_behind, p.valid[front] = r.valid;
  }
  return p;
}
constexpr PartTable part_table = make_part_table();

/// Whether some valid cell has the edge or face `what` in a role.
constexpr bool occurs(const std::int32_t (&part)[16], std::int32_t what) {
  for (unsigned front = 0; front < 16; ++front)
    if (role_table.roles[front].valid && part[front] == what) return true;
  return false;
}

/// Values of a batch's cells, one per cell. Edge functions are start + x column + y row, relative to the square's
/// centre (CellBatch). Planes have the same form, with x = 2^16 high.x + low.x, and (x, y) in the lower and upper 16
/// bits of one integer.
struct CellParts {
  struct Edge {
    alignas(64) float start[CellBatch::most], x[CellBatch::most], y[CellBatch::most];
  };
  /// Values of the faces in the order of Roles::face.
  using ByFace = std::int32_t[4][CellBatch::most];
  struct Planes {
    alignas(64) ByFace start, low, high;
  };

  Edge outline[4], inner[3];
  Planes depth, scalar, weight;
  alignas(64) ByFace depth_c, scalar_c;  ///< scalar_c contains floats
  unsigned three, behind;                ///< bit t: cell t has one face against three; the single face is the back face
};

/// Moves the values of a batch's cells [from, from + lanes) to the places of their roles.
class PartOrder {
 public:
  HWY_INLINE PartOrder(const CellBatch& batch, int from, CellParts& parts)
      : batch_(batch),
        from_(from),
        front_(And(BitCast(DI(), Load(hn::RebindToUnsigned<DI>(), batch.bits + from)), Set(DI(), 15))),
        parts_(parts) {}

  /// Sets the bits of `three` and `behind`, which must be zero before the first call. Returns the cells that have
  /// candidate pixels, one bit each.
  HWY_INLINE unsigned shapes() const {
    const DI d;
    const auto is = [&](const std::int32_t* table) HWY_ATTR { return lookup_16(table, front_) != Zero(d); };
    const auto bits = [&](MI mask) HWY_ATTR { return lane_bits(mask) << from_; };
    parts_.three |= bits(is(part_table.three));
    parts_.behind |= bits(is(part_table.behind));
    const auto columns = Load(d, batch_.x0 + from_) < Load(d, batch_.x1 + from_);
    const auto rows = Load(d, batch_.y0 + from_) < Load(d, batch_.y1 + from_);
    return bits(And(is(part_table.valid), And(columns, rows)));
  }

  /// Sets all other values that are used with this type of view and mesh.
  template <bool perspective, bool per_cell>
  HWY_INLINE void order() const {
    edges<0>(), edges<1>(), edges<2>(), edges<3>();
    inner_edges<0>(), inner_edges<1>(), inner_edges<2>();
    VI face[4];
    for (int k = 0; k < 4; ++k) face[k] = lookup_16(part_table.face[k], front_);
    planes(face, batch_.depth, parts_.depth);
    if constexpr (!per_cell) planes(face, batch_.scalar, parts_.scalar);
    if constexpr (perspective) {
      planes(face, batch_.weight, parts_.weight);
      for (int k = 0; k < 4; ++k) Store(number_of(face[k], batch_.depth_c), DI(), parts_.depth_c[k] + from_);
      if constexpr (!per_cell)
        for (int k = 0; k < 4; ++k)
          Store(number_of(face[k], reinterpret_cast<const std::int32_t(*)[CellBatch::most]>(batch_.scalar_c)), DI(),
                parts_.scalar_c[k] + from_);
    }
  }

 private:
  template <int k>
  HWY_INLINE void edges() const {
    edge<k, false>(part_table.outline[k], parts_.outline[k]);
  }
  template <int k>
  HWY_INLINE void inner_edges() const {
    edge<k, true>(part_table.inner[k], parts_.inner[k]);
  }
  template <int k, bool inner>
  HWY_INLINE void edge(const std::int32_t* part, CellParts::Edge& to) const {
    const DF df;
    const VI which = lookup_16(part, front_);
    // If a role has no edge, the value is certainly not positive.
    VF start = Set(df, -4.0f), x = Zero(df), y = x;
    edges_of<k, inner>(which, start, x, y, std::make_integer_sequence<int, 6>());
    Store(start, df, to.start + from_), Store(x, df, to.x + from_), Store(y, df, to.y + from_);
  }
  template <int k, bool inner, int... e>
  HWY_INLINE void edges_of(VI which, VF& start, VF& x, VF& y, std::integer_sequence<int, e...>) const {
    (edge_if<k, inner, e>(which, start, x, y), ...);
  }
  template <int k, bool inner, int e>
  HWY_INLINE void edge_if(VI which, VF& start, VF& x, VF& y) const {
    if constexpr (occurs(inner ? part_table.inner[k] : part_table.outline[k], e)) {
      const DF df;
      const MF is = RebindMask(df, which == Set(DI(), e));
      start = IfThenElse(is, Load(df, batch_.edge[e] + from_), start);
      x = IfThenElse(is, Load(df, batch_.edge_x[e] + from_), x);
      y = IfThenElse(is, Load(df, batch_.edge_y[e] + from_), y);
    }
  }
  HWY_INLINE VI number_of(VI face, const std::int32_t (*all)[CellBatch::most]) const {
    const DI d;
    VI v = Load(d, all[0] + from_);
    for (int f = 1; f < 4; ++f) v = IfThenElse(face == Set(d, f), Load(d, all[f] + from_), v);
    return v;
  }
  HWY_INLINE void planes(const VI (&face)[4], const CellBatch::FacePlanes& all, CellParts::Planes& to) const {
    const DI d;
    for (int k = 0; k < 4; ++k) {
      const VI x = number_of(face[k], all.x), y = number_of(face[k], all.y);
      Store(number_of(face[k], all.start), d, to.start[k] + from_);
      const VI low = Set(d, 0xffff);
      Store(Or(And(x, low), ShiftLeft<16>(y)), d, to.low[k] + from_);
      // The low half is signed: if it is negative, the high half is one greater.
      const auto high = [](VI v) HWY_ATTR { return v + Set(DI(), 0x8000); };
      Store(Or(BitCast(d, ShiftRight<16>(BitCast(hn::RebindToUnsigned<DI>(), high(x)))), AndNot(low, high(y))), d,
            to.high[k] + from_);
    }
  }

  const CellBatch& batch_;
  int from_;
  VI front_;
  CellParts& parts_;
};

/// Encodes a pixel that the rays of a batch's cell may hit in one integer: the cell, and column and row in the square,
/// 16 bits apart as in CellParts. `uncertain` marks a pixel so close to an edge of the outline that a float does not
/// determine the sign.
struct Hit {
  static constexpr int column_bit = 4, row_bit = column_bit + 16;
  static constexpr std::int32_t uncertain = 1 << 15;
};
/// Queue of hits whose crossings are still to be computed.
struct HitQueue {
  static constexpr std::size_t worth_draining = 512;
  /// Includes the hits of one more cell.
  static constexpr std::size_t most = worth_draining + SegmentWindows::most_pixels;

  std::size_t size = 0;
  alignas(64) std::int32_t hit[most + lanes];
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
