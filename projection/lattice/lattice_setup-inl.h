// SPDX-License-Identifier: BSD-3-Clause
// Set-up of the lattice rasterizer: sixteen cells at once, one cell per lane, in double precision. Included once per
// instruction set (Highway's include guard idiom).
//
// What      For every cell: the pixels that it may cover, its front faces, six edge functions in float, and the planes
//           of depth, scalar and (perspective) weight of its four faces in integers.
//
//                 3            Edges 0 to 5 = 01, 02, 03, 12, 13, 23, each of two faces.
//                /|\           Faces 0 to 3 = 012, 013, 023, 123.
//               / | \          The edge function of ab at a pixel p is twice the signed area of (a, b, p). With
//              0..|..2         u x v = u_x v_y - u_y v_x,
//               \ | /            E(p) = (a - p) x (b - p) = a x b + (a_y - b_y) p_x + (b_x - a_x) p_y.
//                \|/           Its sign is the side of the edge on which the ray passes.
//                 1
//
// How       A face (a, b, c) has the area A = (b - a) x (c - a). It is a front face if A, oriented outward, has the
//           sign of the cell's volume in (x, y, order), where order increases with depth: depth itself or, under
//           perspective, -1 / depth, which is linear in the image, unlike depth. A quantity q that is linear on the
//           face has, by Cramer's rule, these steps from pixel to pixel:
//             q_x = ((q_b - q_a) (c - a)_y - (q_c - q_a) (b - a)_y) / A,
//             q_y = ((b - a)_x (q_c - q_a) - (c - a)_x (q_b - q_a)) / A.
// Accuracy  E is divided by the bound of its rounding error: |E| > 1 is certain. Planes are rounded to integer steps of
//           the lattice per pixel: at most 16 steps within the square.
// Bits      Corners are in canonical order, and each quotient depends on one face alone, so that cells that share a
//           face have equal planes. -ffp-contract=off: areas of edge-on faces become zero.
// Ends      Cells for which this precision is not sufficient are `irregular` and left to rasterize_planes().

#if defined(TESSERA_PROJECTION_LATTICE_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_SETUP_INL_H_
#undef TESSERA_PROJECTION_LATTICE_SETUP_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "projection/lattice/lattice_rasterizer.hpp"
#include "scene/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {
using namespace scene::HWY_NAMESPACE;  // vectors and operations on their lanes

// Edges by their corners i < j, with the two faces that contain them, and faces by their corners a < b < c.
constexpr int edge_from[6] = {0, 0, 0, 1, 1, 2}, edge_to[6] = {1, 2, 3, 2, 3, 3};
constexpr int edge_faces[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 3}, {1, 3}, {2, 3}};
constexpr int face_corners[4][3] = {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}};
/// Whether the corners (a, b, c) of the face have the orientation of (0, 1, 2), seen from outside the cell.
constexpr bool face_outward[4] = {true, false, true, false};
/// Whether E of the edge is positive inside the edge's first face if that face's area, oriented outward, is positive.
constexpr bool edge_inward[6] = {true, false, true, true, false, true};

/// Sixteen cells after set-up. Pixels are numbered from the square's corner; planes and edge functions are relative to
/// the centre of pixel (center, center).
struct CellBatch {
  static constexpr int most = 16, center = 16;
  static constexpr float weight_one = 0x1p30f;
  /// A quantity on faces 0 to 3: its steps from pixel to pixel, and its value at the centre.
  struct FacePlanes {
    alignas(64) std::int32_t start[4][most], x[4][most], y[4][most];
  };

  int size;
  unsigned irregular;  ///< bit t: cell t is left to the double-precision rasterizer
  std::uint32_t tet[most];
  alignas(64) std::int32_t x0[most], x1[most], y0[most], y1[most];  ///< candidate pixels, half-open ranges
  alignas(64) std::uint32_t bits[most];                             ///< front_faces(), edge_on(), flipped()
  // E divided by its rounding error, positive inside the first of the edge's faces.
  alignas(64) float edge[6][most], edge_x[6][most], edge_y[6][most];
  // Planes of faces 0 to 3: depth (perspective: depth relative to corner c, times weight), scalar in the same way, and
  // weight (w of the nearest corner / w, times 2^30).
  FacePlanes depth, scalar, weight;
  alignas(64) std::int32_t depth_c[4][most];
  alignas(64) float scalar_c[4][most];
  alignas(64) float cell_scalar[most];
  /// Lowest and highest scalar of a cell's corners; only with surfaces.
  alignas(64) float scalar_low[most], scalar_high[most];

  static constexpr int front_bit = 0, edge_on_bit = 8, flipped_bit = 16;
  /// Bit f: face f is a front face. Undefined for an irregular cell.
  [[nodiscard]] unsigned front_faces(int t) const { return bits[t] >> front_bit & 15; }
  /// Bit f: face f is seen edge-on.
  [[nodiscard]] unsigned edge_on(int t) const { return bits[t] >> edge_on_bit & 15; }
  /// Bit e: the stored edge function is -E.
  [[nodiscard]] unsigned flipped(int t) const { return bits[t] >> flipped_bit & 63; }
};

/// Returns the nearest integers modulo 2^32, for |v| < 2^51: in the sum with 1.5 * 2^52, the lowest bit has the value
/// 1.
HWY_INLINE hn::Vec<hn::Rebind<std::int32_t, DD>> wrapped(VD v) {
  const DD d;
  const hn::RebindToUnsigned<DD> du;
  const hn::Rebind<std::uint32_t, DD> du32;
  const hn::Rebind<std::int32_t, DD> di32;
  return BitCast(di32, TruncateTo(du32, BitCast(du, v + Set(d, 0x1.8p52))));
}

/// A plane over the square: its value at the centre, and its steps.
struct Plane {
  VD start, x, y;
};

/// A face as a triangle in the image: its first corner, the edges to the others, and twice its signed area.
struct FaceShape {
  VD ax, ay, x1, y1, x2, y2, area;
  VD inverse_area;  ///< set by find_sides()
};

/// Returns the plane of the face on which the quantity has the given values at the corners.
HWY_INLINE Plane plane_of(const FaceShape& face, VD at_a, VD at_b, VD at_c) {
  const VD to_b = at_b - at_a, to_c = at_c - at_a;
  Plane plane;
  plane.x = (to_b * face.y2 - to_c * face.y1) * face.inverse_area;
  plane.y = (face.x1 * to_c - face.x2 * to_b) * face.inverse_area;
  plane.start = NegMulAdd(plane.x, face.ax, NegMulAdd(plane.y, face.ay, at_a));
  return plane;
}

/// Stores the planes of face f, for the cells from `from` on.
HWY_INLINE void store_plane(const Plane& plane, int f, int from, CellBatch::FacePlanes& out) {
  const hn::Rebind<std::int32_t, DD> d;
  StoreU(wrapped(plane.start), d, out.start[f] + from);
  StoreU(wrapped(plane.x), d, out.x[f] + from);
  StoreU(wrapped(plane.y), d, out.y[f] + from);
}

/// Depths outside of these bounds are outside the clipping range, or may be.
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

/// Returns those cells, among the cells deeper than DepthLimits::least_extent, that are too thin for their rounding
/// error (DepthLimits).
template <bool perspective>
HWY_NOINLINE MD rounded_visibly(const LatticeView& view, VD extent, VD volume, VD twice_area, VD w_product) {
  const auto number = [](double v) HWY_ATTR { return Set(DD(), v); };
  const DepthLimits& limits = view.depth_limits;
  // The longest path of a ray through the cell: a third of this path, times the area that the cell covers, is the
  // volume.
  VD chord = Abs(volume) / (twice_area * number(0.5));
  if constexpr (perspective)  // `volume` is of inverse depths there
    chord = chord / (w_product * number(view.lattice.depth_unit));
  const VD light = number(limits.light_per_step);
  const VD error = light * MulAdd(extent, number(perspective ? DepthLimits::usual_quotient_error : 0),
                                  number(DepthLimits::usual_plane_error));
  MD thin = And(error > number(DepthLimits::least_error),
                Not(error * error <= number(DepthLimits::most_error_squared) * (light * chord)));
  if constexpr (perspective)
    thin = Or(thin, light * (extent * number(DepthLimits::most_quotient_error)) > number(DepthLimits::most_error));
  return thin;
}

/// Whether the face may be edge-on.
HWY_INLINE MD thin_face(const FaceShape& face) {
  const VD span = Abs(face.x1) + Abs(face.y1) + (Abs(face.x2) + Abs(face.y2));
  return Abs(face.area) <= span * Set(DD(), 0x1p-9);
}

/// Whether a face is certainly edge-on. Orthographic coordinates and their differences are exact. The products in the
/// area of a face that is certainly edge-on are zero or have the same factors, because two corners coincide or all
/// corners are on a line along an axis.
HWY_INLINE MD edge_on_for_certain(const FaceShape& face) {
  const auto both_zero = [](VD p, VD q) HWY_ATTR { return And(p == Zero(DD()), q == Zero(DD())); };
  return Or(
      Or(both_zero(face.x1, face.x2), both_zero(face.y1, face.y2)),
      Or(Or(both_zero(face.x1, face.y1), both_zero(face.x2, face.y2)), And(face.x1 == face.x2, face.y1 == face.y2)));
}

/// The orientation of the faces of a vector of cells.
struct Sides {
  MD upright;     ///< the cell's volume in (x, y, order) is not negative
  MD front[4];    ///< faces through which rays enter
  MD edge_on[4];  ///< faces that no ray passes: only thin faces of orthographic views
};

/// Finds the front faces, and sets the faces' inverse areas. `thin`: some face may be edge-on, which is rare. The cell
/// of such a face becomes irregular, unless the face is certainly edge-on.
template <bool perspective, bool thin>
HWY_INLINE Sides find_sides(MD upright, FaceShape (&faces)[4], MD& irregular) {
  const VD zero = Zero(DD()), one = Set(DD(), 1);
  const MD none = zero < zero;
  Sides sides{upright, {}, {none, none, none, none}};
  for (int f = 0; f < 4; ++f) {
    FaceShape& face = faces[f];
    MD& edge_on = sides.edge_on[f];
    if constexpr (thin) {
      if constexpr (!perspective) edge_on = edge_on_for_certain(face);
      irregular = Or(irregular, AndNot(edge_on, thin_face(face)));
      face.inverse_area = IfThenZeroElse(edge_on, one / IfThenElse(edge_on, one, face.area));
    } else {
      face.inverse_area = one / face.area;
    }
    const MD positive = face_outward[f] ? face.area > zero : face.area < zero;
    sides.front[f] = Not(Xor(positive, upright));
  }
  if constexpr (thin) {
    // Edge-on faces, which no ray passes, are added to the two sides: the first counts as a front face, the others as
    // back faces.
    MD seen = none;
    for (int f = 0; f < 4; ++f) {
      const MD edge_on = sides.edge_on[f];
      sides.front[f] = Or(AndNot(edge_on, sides.front[f]), AndNot(seen, edge_on));
      seen = Or(seen, edge_on);
    }
  }
  return sides;
}

/// Loads `count` values: the first two or the second two values (`pair` 0 or 1) of the vertices first, first + 2, first
/// + 4... When they are interleaved with those of the vertices in between, each vertex is in its own lane.
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

/// The corners of a vector of cells: pixel position relative to the square's centre, depth and scalar in steps, weight.
struct Corners {
  VD x[4], y[4], depth[4], scalar[4], weight[4];
  VD nearest, farthest;  ///< depths

  HWY_INLINE Corners(const LatticeVertex* vertices, const scene::Tet* const* tets, const MaskedRect& pixels) {
    const DD d;
    const hn::Rebind<std::int32_t, DD> di32;
    const hn::RebindToUnsigned<DD> du64;
    const hn::Rebind<std::uint32_t, DD> du32;
    nearest = Set(d, HUGE_VAL), farthest = Set(d, -HUGE_VAL);
    for (int i = 0; i < 4; ++i) {
      const auto vertex = [&](int lane) HWY_ATTR { return &vertices[(*tets[lane])[static_cast<std::size_t>(i)]]; };
      const auto even = [&](int pair) HWY_ATTR { return load_every_second<MaxLanes(DD())>(vertex, 0, pair); };
      const auto odd = [&](int pair) HWY_ATTR { return load_every_second<MaxLanes(DD())>(vertex, 1, pair); };
      const VD xy_even = even(0), xy_odd = odd(0), rest_even = even(1), rest_odd = odd(1);
      x[i] = InterleaveLower(d, xy_even, xy_odd), y[i] = InterleaveUpper(d, xy_even, xy_odd);
      weight[i] = InterleaveLower(d, rest_even, rest_odd);
      const auto both = BitCast(du64, InterleaveUpper(d, rest_even, rest_odd));
      depth[i] = PromoteTo(d, BitCast(di32, TruncateTo(du32, both)));
      scalar[i] = PromoteTo(d, BitCast(di32, TruncateTo(du32, ShiftRight<32>(both))));
      x[i] = x[i] - Set(d, pixels.square_x() + CellBatch::center + 0.5);
      y[i] = y[i] - Set(d, pixels.square_y() + CellBatch::center + 0.5);
      nearest = Min(nearest, depth[i]), farthest = Max(farthest, depth[i]);
    }
  }
  [[nodiscard]] HWY_INLINE VD least_weight() const { return Min(Min(weight[0], weight[1]), Min(weight[2], weight[3])); }
  [[nodiscard]] HWY_INLINE VD most_weight() const { return Max(Max(weight[0], weight[1]), Max(weight[2], weight[3])); }
};

/// Stores the edge functions and flags of the cells. `span`: width plus height of the boxes.
template <bool thin>
HWY_INLINE void set_up_edges(const Corners& corners, const Sides& sides, VD span, int from, CellBatch& batch) {
  const DD d;
  const hn::RebindToUnsigned<DD> du64;
  const hn::Rebind<std::uint32_t, DD> du32;
  const hn::Rebind<float, DD> df;
  const auto number = [](double v) HWY_ATTR { return Set(DD(), v); };
  const VD(&x)[4] = corners.x, (&y)[4] = corners.y, zero = Zero(d);
  auto bits = Zero(du64);
  const auto add_bit = [&](MD mask, int bit) HWY_ATTR {
    bits = Or(bits, IfThenElseZero(RebindMask(du64, mask), Set(du64, std::uint64_t{1} << bit)));
  };
  for (int f = 0; f < 4; ++f) {
    add_bit(sides.front[f], CellBatch::front_bit + f);
    if constexpr (thin) add_bit(sides.edge_on[f], CellBatch::edge_on_bit + f);
  }

  // E is divided by a bound of the six rounding errors, computed from the largest start and the box. A factor of 2^-23
  // would suffice; the rest is margin.
  VD start[6], along_x[6], along_y[6], error = number(1e-290);
  for (int e = 0; e < 6; ++e) {
    const int a = edge_from[e], b = edge_to[e];
    start[e] = MulSub(x[a], y[b], x[b] * y[a]);
    along_x[e] = y[a] - y[b], along_y[e] = x[b] - x[a];
    error = Max(error, Abs(start[e]));
  }
  const VD scale = number(0x1p22) / MulAdd(span, number(CellBatch::center + 1), error);
  for (int e = 0; e < 6; ++e) {
    const MD inward = edge_inward[e] ? sides.upright : Not(sides.upright);
    const MD flip = Xor(inward, sides.front[edge_faces[e][0]]);
    add_bit(flip, CellBatch::flipped_bit + e);
    const VD signed_scale = IfThenElse(flip, Neg(scale), scale);
    VD scaled = start[e] * signed_scale;
    if constexpr (thin) {
      // An edge without sides is between two edge-on faces, and never determines a hit.
      const MD without_sides = And(along_x[e] == zero, along_y[e] == zero);
      scaled = IfThenElse(without_sides, number(4), scaled);
    }
    StoreU(DemoteTo(df, scaled), df, batch.edge[e] + from);
    StoreU(DemoteTo(df, along_x[e] * signed_scale), df, batch.edge_x[e] + from);
    StoreU(DemoteTo(df, along_y[e] * signed_scale), df, batch.edge_y[e] + from);
  }
  StoreU(TruncateTo(du32, bits), du32, batch.bits + from);
}

/// Stores the candidate pixels within `rect`, which is relative to the square's corner: the pixels whose centres are
/// inside the bounding box, which is widened by far more than rounding. Returns width plus height of the boxes. Cells
/// that are too far away for set-up become irregular.
HWY_INLINE VD set_up_box(const Corners& corners, const scene::PixelRect& rect, int from, MD& irregular,
                         CellBatch& batch) {
  const hn::Rebind<std::int32_t, DD> di32;
  const auto number = [](double v) HWY_ATTR { return Set(DD(), v); };
  const VD(&x)[4] = corners.x, (&y)[4] = corners.y;
  const VD x_low = Min(Min(x[0], x[1]), Min(x[2], x[3]));
  const VD x_high = Max(Max(x[0], x[1]), Max(x[2], x[3]));
  const VD y_low = Min(Min(y[0], y[1]), Min(y[2], y[3]));
  const VD y_high = Max(Max(y[0], y[1]), Max(y[2], y[3]));
  const VD reach = Max(Max(Neg(x_low), x_high), Max(Neg(y_low), y_high));
  irregular = Or(irregular, Not(reach < number(16384)));
  const VD slack = number(1e-6), center = number(CellBatch::center), behind = number(CellBatch::center + 1);
  const auto store_bound = [&](VD v, int low, int high, std::int32_t* out) HWY_ATTR {
    StoreU(DemoteTo(di32, Min(Max(v, number(low)), number(high))), di32, out + from);
  };
  store_bound(Ceil(x_low - slack) + center, rect.x0, rect.x1, batch.x0);
  store_bound(Floor(x_high + slack) + behind, rect.x0, rect.x1, batch.x1);
  store_bound(Ceil(y_low - slack) + center, rect.y0, rect.y1, batch.y0);
  store_bound(Floor(y_high + slack) + behind, rect.y0, rect.y1, batch.y1);
  return x_high - x_low + (y_high - y_low);
}

/// Stores the planes of the faces: depth and, for point data, scalar. Under perspective, a quantity q is not linear in
/// the image, but the weight u (w of the face's nearest corner, divided by w) and u (q - q_c) are linear; the quotient
/// of their planes is q - q_c.
template <bool perspective>
HWY_INLINE void set_up_planes(const Corners& corners, const FaceShape (&faces)[4], bool per_cell, int from,
                              CellBatch& batch) {
  const DD d;
  const hn::Rebind<float, DD> df;
  const hn::Rebind<std::int32_t, DD> di32;
  const VD(&depth)[4] = corners.depth, (&scalar)[4] = corners.scalar, (&weight)[4] = corners.weight;
  for (int f = 0; f < 4; ++f) {
    const int a = face_corners[f][0], b = face_corners[f][1], c = face_corners[f][2];
    const FaceShape& face = faces[f];
    if constexpr (!perspective) {
      store_plane(plane_of(face, depth[a], depth[b], depth[c]), f, from, batch.depth);
      if (!per_cell) store_plane(plane_of(face, scalar[a], scalar[b], scalar[c]), f, from, batch.scalar);
    } else {
      const VD most = Max(weight[a], Max(weight[b], weight[c])), full = Set(d, CellBatch::weight_one);
      const VD u_a = weight[a] / most, u_b = weight[b] / most, u_c = weight[c] / most;
      store_plane(plane_of(face, u_a * full, u_b * full, u_c * full), f, from, batch.weight);
      const auto relative = [&](const VD(&q)[4], VD q_c) HWY_ATTR {
        return plane_of(face, u_a * (q[a] - q_c), u_b * (q[b] - q_c), u_c * (q[c] - q_c));
      };
      const VD depth_c = Round(depth[c]);
      store_plane(relative(depth, depth_c), f, from, batch.depth);
      StoreU(wrapped(depth_c), di32, batch.depth_c[f] + from);
      if (per_cell) continue;
      const VD scalar_c = Round(scalar[c]);
      store_plane(relative(scalar, scalar_c), f, from, batch.scalar);
      StoreU(DemoteTo(df, scalar_c), df, batch.scalar_c[f] + from);
    }
  }
}

/// Stores the lowest and the highest of the corners' scalars.
HWY_INLINE void store_scalar_range(const Corners& corners, int from, CellBatch& batch) {
  const hn::Rebind<float, DD> df;
  const VD(&s)[4] = corners.scalar;
  StoreU(DemoteTo(df, Min(Min(s[0], s[1]), Min(s[2], s[3]))), df, batch.scalar_low + from);
  StoreU(DemoteTo(df, Max(Max(s[0], s[1]), Max(s[2], s[3]))), df, batch.scalar_high + from);
}

/// Sets up one vector of cells, beginning with cell `from` of the batch. `rect` as in set_up_box().
template <bool perspective>
HWY_INLINE void set_up_lanes(const LatticeView& view, const DepthBounds& bounds, const Corners& corners,
                             const scene::PixelRect& rect, int from, CellBatch& batch) {
  const DD d;
  const auto number = [](double v) HWY_ATTR { return Set(DD(), v); };
  const VD zero = Zero(d);
  const VD(&x)[4] = corners.x, (&y)[4] = corners.y, nearest = corners.nearest, farthest = corners.farthest;
  MD irregular = Or(farthest > number(bounds.far), nearest < number(bounds.near));
  if constexpr (perspective) {
    for (const VD& w : corners.weight) irregular = Or(irregular, Not(w > zero));
    irregular = Or(irregular, corners.most_weight() > corners.least_weight() * number(16));
  }
  const VD span = set_up_box(corners, rect, from, irregular, batch);

  MD thin = zero < zero;
  FaceShape faces[4];
  for (int f = 0; f < 4; ++f) {
    const int a = face_corners[f][0], b = face_corners[f][1], c = face_corners[f][2];
    FaceShape& face = faces[f];
    face.ax = x[a], face.ay = y[a];
    face.x1 = x[b] - x[a], face.y1 = y[b] - y[a];
    face.x2 = x[c] - x[a], face.y2 = y[c] - y[a];
    face.area = face.x1 * face.y2 - face.x2 * face.y1;
    thin = Or(thin, thin_face(face));
  }
  // Six times the volume: the determinant of the edges from corner 0, in (x, y, order).
  VD order[4];
  for (int i = 0; i < 4; ++i) order[i] = perspective ? Neg(corners.weight[i]) : corners.depth[i];
  const VD z1 = order[1] - order[0], z2 = order[2] - order[0], z3 = order[3] - order[0];
  const VD x1 = faces[0].x1, y1 = faces[0].y1, x2 = faces[0].x2, y2 = faces[0].y2, x3 = faces[1].x2, y3 = faces[1].y2;
  const VD volume =
      MulAdd(z1, MulSub(x2, y3, x3 * y2), MulAdd(z2, MulSub(x3, y1, x1 * y3), z3 * MulSub(x1, y2, x2 * y1)));
  const VD extent = farthest - nearest;
  const MD deep = extent > number(view.depth_limits.least_extent);
  if (HWY_UNLIKELY(!AllFalse(d, deep))) {
    const VD twice_area = Abs(faces[0].area) + Abs(faces[1].area) + (Abs(faces[2].area) + Abs(faces[3].area));
    irregular = Or(irregular, And(deep, rounded_visibly<perspective>(view, extent, volume, twice_area,
                                                                     corners.most_weight() * corners.least_weight())));
  }
  const MD upright = volume >= zero;
  if (HWY_UNLIKELY(!AllFalse(d, thin)))
    set_up_edges<true>(corners, find_sides<perspective, true>(upright, faces, irregular), span, from, batch);
  else
    set_up_edges<false>(corners, find_sides<perspective, false>(upright, faces, irregular), span, from, batch);

  const bool per_cell = view.projected.mesh->mesh().association == scene::Association::cell;
  set_up_planes<perspective>(corners, faces, per_cell, from, batch);
  if (HWY_UNLIKELY(view.projected.iso != nullptr)) store_scalar_range(corners, from, batch);
  batch.irregular |= lane_bits(irregular) << from;
}

/// Stores the scalars of cell data.
HWY_INLINE void store_cell_scalars(const scene::Lattice& lattice, const double* scalars, int from, CellBatch& batch) {
  const DD d;
  const hn::Rebind<float, DD> df;
  const VD scalar = (LoadU(d, scalars) - Set(d, lattice.scalar_origin)) * Set(d, 1 / lattice.scalar_unit);
  StoreU(DemoteTo(df, Round(scalar)), df, batch.cell_scalar + from);
}

/// Prefetches data of later batches while this batch is processed, because lists refer to cells all over the mesh: the
/// corner indices of the batches that follow, and the vertices of the next batch. `ahead` begins with the next batch.
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
HWY_INLINE void set_up_cells(const LatticeView& view, std::span<const TileEntry> cells, const MaskedRect& pixels,
                             CellBatch& batch) {
  const PreparedMesh& prepared = *view.projected.mesh;
  const bool per_cell = prepared.mesh().association == scene::Association::cell;
  const DepthBounds bounds(view);
  const auto lanes = static_cast<int>(hn::Lanes(DD()));
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
    set_up_lanes<perspective>(view, bounds, Corners(view.vertices.data(), corners, pixels), pixels.in_square(), from,
                              batch);
    if (per_cell) store_cell_scalars(view.lattice, cell_scalar, from, batch);
  }
  batch.irregular &= (1u << batch.size) - 1;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
