// SPDX-License-Identifier: BSD-3-Clause
// Set-up of the lattice rasterizer: sixteen cells at once, a cell a lane, in double precision. Included once per
// instruction set (Highway's include guard idiom).

#if defined(TESSERA_PROJECTION_LATTICE_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_SETUP_INL_H_
#undef TESSERA_PROJECTION_LATTICE_SETUP_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "projection/lattice/lattice_rasterizer.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

// Edges by their corners i < j with the two faces they lie in, and faces by their corners a < b < c with the edges bc,
// ac, ab.
constexpr int edge_from[6] = {0, 0, 0, 1, 1, 2}, edge_to[6] = {1, 2, 3, 2, 3, 3};
constexpr int edge_faces[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
constexpr int face_corners[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
/// (a, b, c) turns the way that (0, 1, 2) does, seen from outside the cell.
constexpr bool face_outward[4] = {true, false, true, false};
/// E of the edge is positive inside its first face if that face's area is, turned outward.
constexpr bool edge_inward[6] = {true, false, true, true, false, true};

/// Sixteen cells ready for their pixels. Pixels are numbered from the square's corner; planes and edge functions start
/// at the centre of pixel (center, center).
struct CellBatch {
  static constexpr int most = 16, center = 16;
  static constexpr float weight_one = 0x1p30f;
  /// A quantity on faces 0 to 3: steps from pixel to pixel, and at the centre.
  struct FacePlanes {
    alignas(64) std::int32_t start[4][most], x[4][most], y[4][most];
  };

  int size;
  unsigned irregular;  ///< bit t: left to the double-precision rasterizer
  std::uint32_t tet[most];
  alignas(64) std::int32_t x0[most], x1[most], y0[most], y1[most];  ///< candidate pixels, half open
  alignas(64) std::uint32_t bits[most];                             ///< see front_faces() and so on
  // E / (its rounding error), positive inside the first of the edge's faces.
  alignas(64) float edge[6][most], edge_x[6][most], edge_y[6][most];
  // Planes of faces 0 to 3: depth (perspective: depth behind corner c, times weight), scalar likewise, and weight (w of
  // the nearest corner / w, times 2^30).
  FacePlanes depth, scalar, weight;
  alignas(64) std::int32_t depth_c[4][most];
  alignas(64) float scalar_c[4][most];
  alignas(64) float cell_scalar[most];
  alignas(64) float scalar_low[most], scalar_high[most];  ///< of a cell's corners; where there are surfaces alone

  /// Bit f: a front face. Of an irregular cell it says nothing.
  [[nodiscard]] unsigned front_faces(int t) const { return bits[t] & 15; }
  /// Bit f: seen edge-on.
  [[nodiscard]] unsigned edge_on(int t) const { return bits[t] >> 8 & 15; }
  /// Bit e: the stored edge function is -E.
  [[nodiscard]] unsigned flipped(int t) const { return bits[t] >> 16 & 63; }
};

/// Nearest integers modulo 2^32 of |v| < 2^51: in the sum with 1.5 * 2^52 the lowest bit counts ones.
HWY_INLINE hn::Vec<hn::Rebind<std::int32_t, D>> wrapped(V v) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const hn::Rebind<std::uint32_t, D> du32;
  const hn::Rebind<std::int32_t, D> di32;
  return BitCast(di32, TruncateTo(du32, BitCast(du, v + Set(d, 0x1.8p52))));
}

/// A plane over the square: value at its centre and steps.
struct Plane {
  V start, x, y;
};

/// The face's plane through the values q at its corners.
struct FaceShape {
  V ax, ay, x1, y1, x2, y2, inverse_area;
};
HWY_INLINE Plane plane_of(const FaceShape& s, V qa, V qb, V qc) {
  const V q1 = qb - qa, q2 = qc - qa;
  Plane p;
  p.x = (q1 * s.y2 - q2 * s.y1) * s.inverse_area;
  p.y = (s.x1 * q2 - s.x2 * q1) * s.inverse_area;
  p.start = NegMulAdd(p.x, s.ax, NegMulAdd(p.y, s.ay, qa));
  return p;
}

/// Those of face f, of the cells from `from` on.
HWY_INLINE void store_plane(const Plane& plane, int f, int from, CellBatch::FacePlanes& out) {
  const hn::Rebind<std::int32_t, D> d;
  StoreU(wrapped(plane.start), d, out.start[f] + from);
  StoreU(wrapped(plane.x), d, out.x[f] + from);
  StoreU(wrapped(plane.y), d, out.y[f] + from);
}

HWY_INLINE unsigned bits_of(M mask) {
  std::uint8_t bits[8] = {0};
  StoreMaskBits(D(), mask, bits);
  return bits[0];
}

/// Depths outside these are, or may be, outside the clipping range.
struct DepthBounds {
  double near, far;  ///< steps
  explicit DepthBounds(const LatticeView& view) {
    const scene::Lattice& l = view.lattice;
    const auto steps = [&](double depth, double sign) {
      return std::clamp((depth - l.depth_origin) / l.depth_unit + sign, -2 * scene::Lattice::limit,
                        2 * scene::Lattice::limit);
    };
    near = steps(view.projected.near_depth, 1), far = steps(view.projected.far_depth, -1);
  }
};

/// Of cells that are deeper than DepthLimits::least_extent: those that are too thin for their rounding (DepthLimits).
template <bool perspective>
HWY_NOINLINE M rounded_visibly(const LatticeView& view, V extent, V volume, V twice_area, V w_product) {
  const auto number = [](double v) HWY_ATTR { return Set(D(), v); };
  const DepthLimits& limits = view.depth_limits;
  // The longest way through the cell: a third of it times the area that the cell covers is the volume.
  V chord = Abs(volume) / (twice_area * number(0.5));
  if constexpr (perspective)  // `volume` is of inverse depths there
    chord = chord / (w_product * number(view.lattice.depth_unit));
  const V light = number(limits.light_per_step);
  const V error = light * MulAdd(extent, number(perspective ? DepthLimits::usual_quotient_error : 0),
                                 number(DepthLimits::usual_plane_error));
  M thin = And(error > number(DepthLimits::least_error),
               Not(error * error <= number(DepthLimits::most_error_squared) * (light * chord)));
  if constexpr (perspective)
    thin = Or(thin, light * (extent * number(DepthLimits::most_quotient_error)) > number(DepthLimits::most_error));
  return thin;
}

/// Whether the faces may be seen edge-on.
HWY_INLINE M thin_face(const FaceShape& n, V area) {
  const V span = Abs(n.x1) + Abs(n.y1) + (Abs(n.x2) + Abs(n.y2));
  return Abs(area) <= span * Set(D(), 0x1p-9);
}

/// Which faces are front faces, and the edge functions. `thin`: some face may be edge-on, which few are.
template <bool perspective, bool thin>
HWY_INLINE void set_up_sides(FaceShape (&shape)[4], const V (&area)[4], M upright, const V (&x)[4], const V (&y)[4],
                             V span, int from, M& irregular, CellBatch& batch) {
  const D d;
  const hn::RebindToUnsigned<D> du64;
  const hn::Rebind<std::uint32_t, D> du32;
  const hn::Rebind<float, D> df;
  const auto number = [](double v) HWY_ATTR { return Set(D(), v); };
  const V zero = Zero(d), one = number(1);
  const M none = zero < zero;
  M is_zero[4] = {none, none, none, none}, front[4];
  // What is true of a cell, a bit each: front faces from bit 0, edge-on faces from 8, flipped edges from 16.
  auto bits = Zero(du64);
  const auto add_bit = [&](M mask, int bit) HWY_ATTR {
    bits = Or(bits, IfThenElseZero(RebindMask(du64, mask), Set(du64, std::uint64_t{1} << bit)));
  };
  for (int f = 0; f < 4; ++f) {
    FaceShape& n = shape[f];
    if constexpr (thin) {
      // Edge-on for certain: orthographic coordinates and their differences are exact, and the products are zeros or
      // have the same factors, as where two corners coincide or all line up along an axis.
      if constexpr (!perspective) {
        const auto both_zero = [&](V p, V q) HWY_ATTR { return And(p == zero, q == zero); };
        is_zero[f] = Or(Or(both_zero(n.x1, n.x2), both_zero(n.y1, n.y2)),
                        Or(Or(both_zero(n.x1, n.y1), both_zero(n.x2, n.y2)), And(n.x1 == n.x2, n.y1 == n.y2)));
      }
      irregular = Or(irregular, AndNot(is_zero[f], thin_face(n, area[f])));
      n.inverse_area = IfThenZeroElse(is_zero[f], one / IfThenElse(is_zero[f], one, area[f]));
    } else {
      n.inverse_area = one / area[f];
    }
    const M positive = face_outward[f] ? area[f] > zero : area[f] < zero;
    front[f] = Not(Xor(positive, upright));
  }
  if constexpr (thin) {
    // Edge-on faces, which no ray passes, fill up the sides: the first counts as a front face, others as back faces.
    M seen_zero = none;
    for (int f = 0; f < 4; ++f) {
      front[f] = Or(AndNot(is_zero[f], front[f]), And(is_zero[f], Not(seen_zero)));
      seen_zero = Or(seen_zero, is_zero[f]);
      add_bit(is_zero[f], 8 + f);
    }
  }
  for (int f = 0; f < 4; ++f) add_bit(front[f], f);

  // Edge functions over a bound of the six rounding errors, from the largest start and the box; 2^-23 would do, the
  // rest is margin.
  V start[6], along_x[6], along_y[6], error = number(1e-290);
  for (int e = 0; e < 6; ++e) {
    const int a = edge_from[e], b = edge_to[e];
    start[e] = MulSub(x[a], y[b], x[b] * y[a]);
    along_x[e] = y[a] - y[b], along_y[e] = x[b] - x[a];
    error = Max(error, Abs(start[e]));
  }
  const V scale = number(0x1p22) / MulAdd(span, number(CellBatch::center + 1), error);
  for (int e = 0; e < 6; ++e) {
    const M inward = edge_inward[e] ? upright : Not(upright);
    const M flip = Xor(inward, front[edge_faces[e][0]]);
    add_bit(flip, 16 + e);
    const V signed_scale = IfThenElse(flip, Neg(scale), scale);
    V scaled = start[e] * signed_scale;
    if constexpr (thin) {
      // An edge without sides lies between two edge-on faces; it never decides.
      const M without_sides = And(along_x[e] == zero, along_y[e] == zero);
      scaled = IfThenElse(without_sides, number(4), scaled);
    }
    StoreU(DemoteTo(df, scaled), df, batch.edge[e] + from);
    StoreU(DemoteTo(df, along_x[e] * signed_scale), df, batch.edge_x[e] + from);
    StoreU(DemoteTo(df, along_y[e] * signed_scale), df, batch.edge_y[e] + from);
  }
  StoreU(TruncateTo(du32, bits), du32, batch.bits + from);
}

/// `count` numbers: of vertices first, first + 2, first + 4... the first two or the second two (`pair` 0 or 1). Beside
/// those of the vertices between them, lanes are but to be interleaved to have a vertex each.
template <std::size_t count, class Vertex>
HWY_INLINE auto load_every_second(const Vertex& vertex, int first, int pair) {
  if constexpr (count == 2) {
    return LoadU(hn::FixedTag<double, 2>(), reinterpret_cast<const double*>(vertex(first)) + 2 * pair);
  } else {
    const auto low = load_every_second<count / 2>(vertex, first, pair);
    const auto high = load_every_second<count / 2>(vertex, first + static_cast<int>(count / 2), pair);
    return Combine(hn::FixedTag<double, count>(), high, low);
  }
}

/// A vector of cells' corners: place in the picture from the square's centre, depth and scalar in steps, weight.
struct Corners {
  V x[4], y[4], z[4], s[4], w[4];
  V nearest, farthest;  ///< of z

  HWY_INLINE Corners(const LatticeVertex* vertices, const scene::Tet* const* tets, int square_x, int square_y) {
    const D d;
    const hn::Rebind<std::int32_t, D> di32;
    const hn::RebindToUnsigned<D> du64;
    const hn::Rebind<std::uint32_t, D> du32;
    nearest = Set(d, HUGE_VAL), farthest = Set(d, -HUGE_VAL);
    for (int i = 0; i < 4; ++i) {
      const auto vertex = [&](int lane) HWY_ATTR { return &vertices[(*tets[lane])[static_cast<std::size_t>(i)]]; };
      const auto even = [&](int pair) HWY_ATTR { return load_every_second<MaxLanes(D())>(vertex, 0, pair); };
      const auto odd = [&](int pair) HWY_ATTR { return load_every_second<MaxLanes(D())>(vertex, 1, pair); };
      const V xy_even = even(0), xy_odd = odd(0), rest_even = even(1), rest_odd = odd(1);
      x[i] = InterleaveLower(d, xy_even, xy_odd), y[i] = InterleaveUpper(d, xy_even, xy_odd);
      w[i] = InterleaveLower(d, rest_even, rest_odd);
      const auto both = BitCast(du64, InterleaveUpper(d, rest_even, rest_odd));
      z[i] = PromoteTo(d, BitCast(di32, TruncateTo(du32, both)));
      s[i] = PromoteTo(d, BitCast(di32, TruncateTo(du32, ShiftRight<32>(both))));
      x[i] = x[i] - Set(d, square_x + CellBatch::center + 0.5);
      y[i] = y[i] - Set(d, square_y + CellBatch::center + 0.5);
      nearest = Min(nearest, z[i]), farthest = Max(farthest, z[i]);
    }
  }
  [[nodiscard]] HWY_INLINE V least_weight() const { return Min(Min(w[0], w[1]), Min(w[2], w[3])); }
  [[nodiscard]] HWY_INLINE V most_weight() const { return Max(Max(w[0], w[1]), Max(w[2], w[3])); }
};

/// Stores the candidate pixels: centres inside the bounding box, widened by far more than rounding. Returns the box's
/// width and height together; cells too far off to be set up become irregular.
HWY_INLINE V set_up_box(const Corners& corners, const scene::PixelRect& rect, int square_x, int square_y, int from,
                        M& irregular, CellBatch& batch) {
  const hn::Rebind<std::int32_t, D> di32;
  const auto number = [](double v) HWY_ATTR { return Set(D(), v); };
  const V(&x)[4] = corners.x, (&y)[4] = corners.y;
  const V x_low = Min(Min(x[0], x[1]), Min(x[2], x[3]));
  const V x_high = Max(Max(x[0], x[1]), Max(x[2], x[3]));
  const V y_low = Min(Min(y[0], y[1]), Min(y[2], y[3]));
  const V y_high = Max(Max(y[0], y[1]), Max(y[2], y[3]));
  const V reach = Max(Max(Neg(x_low), x_high), Max(Neg(y_low), y_high));
  irregular = Or(irregular, Not(reach < number(16384)));
  const V slack = number(1e-6), center = number(CellBatch::center), behind = number(CellBatch::center + 1);
  const auto store_bound = [&](V v, int low, int high, std::int32_t* out) HWY_ATTR {
    StoreU(DemoteTo(di32, Min(Max(v, number(low)), number(high))), di32, out + from);
  };
  const int left = rect.x0 - square_x, right = rect.x1 - square_x, top = rect.y0 - square_y,
            bottom = rect.y1 - square_y;
  store_bound(Ceil(x_low - slack) + center, left, right, batch.x0);
  store_bound(Floor(x_high + slack) + behind, left, right, batch.x1);
  store_bound(Ceil(y_low - slack) + center, top, bottom, batch.y0);
  store_bound(Floor(y_high + slack) + behind, top, bottom, batch.y1);
  return x_high - x_low + (y_high - y_low);
}

/// Stores the faces' planes: depth and, of point data, scalar.
template <bool perspective>
HWY_INLINE void set_up_planes(const Corners& corners, const FaceShape (&shape)[4], bool per_cell, int from,
                              CellBatch& batch) {
  const D d;
  const hn::Rebind<float, D> df;
  const hn::Rebind<std::int32_t, D> di32;
  const V(&z)[4] = corners.z, (&s)[4] = corners.s, (&w)[4] = corners.w;
  if constexpr (!perspective) {
    const auto planes = [&](const V(&q)[4], CellBatch::FacePlanes& out) HWY_ATTR {
      for (int f = 0; f < 4; ++f)
        store_plane(plane_of(shape[f], q[face_corners[f][0]], q[face_corners[f][1]], q[face_corners[f][2]]), f, from,
                    out);
    };
    planes(z, batch.depth);
    if (!per_cell) planes(s, batch.scalar);
  } else {
    for (int f = 0; f < 4; ++f) {
      const V wa = w[face_corners[f][0]], wb = w[face_corners[f][1]], wc = w[face_corners[f][2]];
      const V most = Max(wa, Max(wb, wc)), full = Set(d, CellBatch::weight_one);
      const V weight[3] = {wa / most, wb / most, wc / most};
      store_plane(plane_of(shape[f], weight[0] * full, weight[1] * full, weight[2] * full), f, from, batch.weight);
      const auto relative = [&](const V(&q)[4], V qc) HWY_ATTR {
        return plane_of(shape[f], weight[0] * (q[face_corners[f][0]] - qc), weight[1] * (q[face_corners[f][1]] - qc),
                        weight[2] * (q[face_corners[f][2]] - qc));
      };
      const V depth_c = Round(z[face_corners[f][2]]);
      store_plane(relative(z, depth_c), f, from, batch.depth);
      StoreU(wrapped(depth_c), di32, batch.depth_c[f] + from);
      if (per_cell) continue;
      const V scalar_c = Round(s[face_corners[f][2]]);
      store_plane(relative(s, scalar_c), f, from, batch.scalar);
      StoreU(DemoteTo(df, scalar_c), df, batch.scalar_c[f] + from);
    }
  }
}

/// Stores the lowest and the highest of the corners' scalars.
HWY_INLINE void store_scalar_range(const Corners& corners, int from, CellBatch& batch) {
  const hn::Rebind<float, D> df;
  const V(&s)[4] = corners.s;
  StoreU(DemoteTo(df, Min(Min(s[0], s[1]), Min(s[2], s[3]))), df, batch.scalar_low + from);
  StoreU(DemoteTo(df, Max(Max(s[0], s[1]), Max(s[2], s[3]))), df, batch.scalar_high + from);
}

/// One vector of cells: the first of them is cell `from` of the batch. `cell_scalar` is read of cell data only.
template <bool perspective>
HWY_INLINE void set_up_lanes(const LatticeView& view, const DepthBounds& bounds, const scene::Tet* const* tets,
                             const double* cell_scalar, const scene::PixelRect& rect, int square_x, int square_y,
                             int from, CellBatch& batch) {
  const D d;
  const hn::Rebind<float, D> df;
  const auto number = [](double v) HWY_ATTR { return Set(D(), v); };
  const V zero = Zero(d);
  const Corners corners(view.vertices.data(), tets, square_x, square_y);
  const V(&x)[4] = corners.x, (&y)[4] = corners.y, nearest = corners.nearest, farthest = corners.farthest;
  M irregular = Or(farthest > number(bounds.far), nearest < number(bounds.near));
  V order[4];
  for (int i = 0; i < 4; ++i) order[i] = perspective ? Neg(corners.w[i]) : corners.z[i];
  if constexpr (perspective) {
    for (const V& w : corners.w) irregular = Or(irregular, Not(w > zero));
    irregular = Or(irregular, corners.most_weight() > corners.least_weight() * number(16));
  }
  const V span = set_up_box(corners, rect, square_x, square_y, from, irregular, batch);

  // Faces: area, which side of the cell, planes.
  M thin = zero < zero;
  FaceShape shape[4];
  V area[4];
  for (int f = 0; f < 4; ++f) {
    const int a = face_corners[f][0], b = face_corners[f][1], c = face_corners[f][2];
    FaceShape& n = shape[f];
    n.ax = x[a], n.ay = y[a];
    n.x1 = x[b] - x[a], n.y1 = y[b] - y[a];
    n.x2 = x[c] - x[a], n.y2 = y[c] - y[a];
    area[f] = n.x1 * n.y2 - n.x2 * n.y1;
    thin = Or(thin, thin_face(n, area[f]));
  }
  // The cell's volume has the sign of a front face's outward area: order grows with depth, and is linear on faces.
  const V z1 = order[1] - order[0], z2 = order[2] - order[0], z3 = order[3] - order[0];
  const V X1 = shape[0].x1, Y1 = shape[0].y1, X2 = shape[0].x2, Y2 = shape[0].y2, X3 = shape[1].x2, Y3 = shape[1].y2;
  const V volume =
      MulAdd(z1, MulSub(X2, Y3, X3 * Y2), MulAdd(z2, MulSub(X3, Y1, X1 * Y3), z3 * MulSub(X1, Y2, X2 * Y1)));
  const M upright = volume >= zero;
  const V extent = farthest - nearest;
  const M deep = extent > number(view.depth_limits.least_extent);
  if (HWY_UNLIKELY(!AllFalse(d, deep))) {
    const V twice_area = Abs(area[0]) + Abs(area[1]) + (Abs(area[2]) + Abs(area[3]));
    irregular = Or(irregular, And(deep, rounded_visibly<perspective>(view, extent, volume, twice_area,
                                                                     corners.most_weight() * corners.least_weight())));
  }
  if (HWY_UNLIKELY(!AllFalse(d, thin)))
    set_up_sides<perspective, true>(shape, area, upright, x, y, span, from, irregular, batch);
  else
    set_up_sides<perspective, false>(shape, area, upright, x, y, span, from, irregular, batch);

  const bool per_cell = view.projected.mesh->mesh().association == scene::Association::cell;
  set_up_planes<perspective>(corners, shape, per_cell, from, batch);
  if (per_cell) {
    const V scalar =
        (LoadU(d, cell_scalar) - number(view.lattice.scalar_origin)) * number(1 / view.lattice.scalar_unit);
    StoreU(DemoteTo(df, Round(scalar)), df, batch.cell_scalar + from);
  }

  if (HWY_UNLIKELY(view.projected.iso != nullptr)) store_scalar_range(corners, from, batch);
  batch.irregular |= bits_of(irregular) << from;
}

/// Lists name cells all over the mesh: fetch the next batches' corner indices, and their vertices, while this batch is
/// worked on. `ahead` begins with the next batch.
HWY_INLINE void prefetch_cells(const LatticeView& view, std::span<const TileEntry> ahead) {
  const std::span<const scene::Tet> tets = view.projected.mesh->tets();
  const scene::TetMeshView& mesh = view.projected.mesh->mesh();
  const bool per_cell = mesh.association == scene::Association::cell;
  const std::size_t near = std::min<std::size_t>(ahead.size(), CellBatch::most);
  for (std::size_t i = 0; i < near; ++i)
    for (const std::uint32_t v : tets[ahead[i].tet]) __builtin_prefetch(&view.vertices[v]);
  const std::size_t far = std::min<std::size_t>(ahead.size(), 3 * CellBatch::most);
  for (std::size_t i = 2 * CellBatch::most; i < far; ++i) {
    __builtin_prefetch(&tets[ahead[i].tet]);
    if (per_cell) __builtin_prefetch(&mesh.scalars[ahead[i].tet]);
  }
}

/// Sets up at most CellBatch::most cells.
template <bool perspective>
HWY_INLINE void set_up_cells(const LatticeView& view, std::span<const TileEntry> cells, const scene::PixelRect& rect,
                             CellBatch& batch) {
  const int square_x = rect.x0 & ~(SegmentWindows::side - 1), square_y = rect.y0 & ~(SegmentWindows::side - 1);
  const PreparedMesh& prepared = *view.projected.mesh;
  const bool per_cell = prepared.mesh().association == scene::Association::cell;
  const DepthBounds bounds(view);
  const auto lanes = static_cast<int>(hn::Lanes(D()));
  const std::span<const scene::Tet> tets = prepared.tets();
  const CellsAtSteps* const at_steps = view.at_steps;
  batch.size = static_cast<int>(cells.size());
  batch.irregular = 0;
  for (int from = 0; from < batch.size; from += lanes) {
    const scene::Tet* corners[8];
    double cell_scalar[8];
    for (int lane = 0; lane < lanes; ++lane) {
      const int t = std::min(from + lane, batch.size - 1);
      const std::uint32_t tet = cells[static_cast<std::size_t>(t)].tet;
      batch.tet[from + lane] = tet;
      if (at_steps != nullptr && at_steps->contain(tet)) batch.irregular |= 1u << t;
      corners[lane] = &tets[tet];
      if (per_cell) cell_scalar[lane] = prepared.mesh().scalars[tet];
    }
    set_up_lanes<perspective>(view, bounds, corners, cell_scalar, rect, square_x, square_y, from, batch);
  }
  batch.irregular &= (1u << batch.size) - 1;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
