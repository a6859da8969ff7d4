// SPDX-License-Identifier: BSD-3-Clause
#include "projection/planes_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include "projection/edge_sign.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/planes_rasterizer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "scene/lanes/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
using namespace scene::HWY_NAMESPACE;  // vectors and operations on their lanes

// Edges by their corners i < j, and faces by their corners a < b < c and the edges bc, ac, ab.
constexpr int edge_from[6] = {0, 0, 0, 1, 1, 2}, edge_to[6] = {1, 2, 3, 2, 3, 3};
struct Face {
  int a, b, c, bc, ac, ab;
  bool outward;  ///< (a, b, c) has the orientation of (0, 1, 2), seen from outside the cell
};
constexpr Face faces[4] = {
    {0, 1, 2, 3, 1, 0, true}, {0, 1, 3, 4, 2, 0, false}, {0, 2, 3, 5, 2, 1, true}, {1, 2, 3, 5, 4, 3, false}};

/// Number of values of a segment that are linear in a cell: the scalar, and the attribute if there is one.
template <class Segments>
constexpr int value_count = std::is_same_v<Segments, AttributeSegments> ? 2 : 1;

/// A cell after set-up. `values` is the number of linear values; the first value is the scalar.
template <int values>
struct Cell {
  PixelVertex corner[4];
  double value[values][4];
  /// Added to |E| before |E| is compared with the error bound. Infinite for an edge without sides, that is, an edge
  /// that contains the eye or whose ends project to one point: its sign would be uncertain at every pixel and is not
  /// needed, because the two faces at the edge are edge-on (pierceable = false).
  double certainty[6];
  bool pierceable[4];
  double pixels_per_tangent;  ///< as in ProjectedMesh
  double error_bound;         ///< upper bound of the error of any E at any candidate pixel
  scene::PixelRect box;
};

// Bounds the difference between exact and computed E. q = X - px * W is rounded once (twice without FMA, because the
// product px * W is also rounded), and E = qx_a * qy_b - qx_b * qy_a is rounded twice more. The exact E is that of
// lines of sight, whose positions differ from X and Y.
double error_bound_of(const PixelVertex (&corner)[4], const scene::PixelRect& box, double pixels_per_tangent) {
  constexpr double u = 0x1p-53;
  const double x0 = box.x0, x1 = box.x1, y0 = box.y0, y1 = box.y1;
  double qx = 0, qy = 0, w = 0, beside = 0;
  for (const PixelVertex& v : corner) {
    qx = std::max({qx, std::abs(v.x - x0 * v.w), std::abs(v.x - x1 * v.w)});
    qy = std::max({qy, std::abs(v.y - y0 * v.w), std::abs(v.y - y1 * v.w)});
    w = std::max(w, std::abs(v.w));
    beside = std::max(beside, sight_error(v, pixels_per_tangent, std::max(x1, y1)));
  }
  const double error_x = u * (qx + 2 * x1 * w) + beside, error_y = u * (qy + 2 * y1 * w) + beside;
  return 4 * (qx * error_y + qy * error_x) + 8 * u * qx * qy;
}

template <int values>
HWY_INLINE Cell<values> set_up(const ProjectedMesh& projected, std::uint32_t tet, const scene::PixelRect& rect) {
  Cell<values> cell;
  const scene::TetMeshView& mesh = projected.mesh->mesh();
  const scene::Tet& corners = projected.mesh->tets()[tet];
  for (int i = 0; i < 4; ++i) cell.corner[i] = projected.vertices[corners[i]];
  const bool per_cell = mesh.association == scene::Association::cell;
  for (int i = 0; i < 4; ++i) cell.value[0][i] = mesh.scalars[per_cell ? tet : corners[i]] - projected.scalar_origin;
  if constexpr (values == 2)
    for (int i = 0; i < 4; ++i) cell.value[1][i] = projected.attribute[corners[i]];
  cell.box = footprint({cell.corner[0], cell.corner[1], cell.corner[2], cell.corner[3]}, rect);
  if (cell.box.empty()) return cell;
  cell.pixels_per_tangent = projected.pixels_per_tangent;
  for (bool& p : cell.pierceable) p = true;
  for (int e = 0; e < 6; ++e) {
    const PixelVertex &a = cell.corner[edge_from[e]], &b = cell.corner[edge_to[e]];
    // An edge has no sides if both ends are on one line of sight, or if the eye is on the edge (then some w <= 0).
    const bool one_point = (a.w == b.w && a.x == b.x && a.y == b.y) ||
                           ((a.w <= 0 || b.w <= 0) && edge_sign(a, b, 0.5, 0.5, cell.pixels_per_tangent) == 0);
    cell.certainty[e] = one_point ? HUGE_VAL : 0;
    if (one_point)
      for (int f = 0; f < 4; ++f)
        if (faces[f].bc == e || faces[f].ac == e || faces[f].ab == e) cell.pierceable[f] = false;
  }
  cell.error_bound = error_bound_of(cell.corner, cell.box, cell.pixels_per_tangent);
  return cell;
}

/// Returns |E| of a perspective edge that the ray meets, after an infinitesimal shift of the ray: the rate of change of
/// E. A ray that meets a face whose plane contains the eye runs along this plane, where all three E are zero. These
/// rates are then the weights of the face's corners, and the resulting depth is that of the eye.
double magnitude_beside(const PixelVertex& from, const PixelVertex& to, double pixels_per_tangent) {
  const LineOfSight a = line_of_sight(from, pixels_per_tangent), b = line_of_sight(to, pixels_per_tangent);
  const double by_x = a.y * b.w - a.w * b.y, by_y = a.w * b.x - a.x * b.w;
  const double scale = (a.w == 0 ? 1 : std::abs(from.w)) * (b.w == 0 ? 1 : std::abs(to.w));
  return std::abs(by_x != 0 ? by_x : by_y) * scale * 0x1p-70;
}

/// Replaces the edge functions of uncertain lanes by values with the exact sign (0 for an edge without sides).
template <int values>
HWY_NOINLINE void settle_signs(const Cell<values>& cell, const double* px, const double* py, std::uint64_t lanes,
                               double (*edges)[8], RasterCounts& counts) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = __builtin_ctzll(lanes);
    for (int e = 0; e < 6; ++e) {
      double& value = edges[e][lane];
      if (std::abs(value) > cell.error_bound) continue;
      bool on_edge = false;
      const PixelVertex &from = cell.corner[edge_from[e]], &to = cell.corner[edge_to[e]];
      const int sign = edge_sign(from, to, px[lane], py[lane], cell.pixels_per_tangent, &on_edge);
      ++counts.exact_sign_tests;
      // Within the error bound, the magnitude is noise: any magnitude this small is equally valid. It is kept, with the
      // exact sign.
      const double magnitude = on_edge && cell.pixels_per_tangent != 0
                                   ? magnitude_beside(from, to, cell.pixels_per_tangent)
                                   : std::max(std::abs(value), cell.error_bound * 0x1p-20);
      value = sign * std::max(magnitude, 1e-290);
    }
  }
}

/// The position of an eye that is exactly on a vertex or an edge of the cell: value[from] + (value[to] - value[from]) *
/// part. The eye is the origin of homogeneous space, and the two ends of the edge are on opposite sides of the eye. So
/// the ratio of the ends' coordinates is the same for x, y and w; the largest coordinate gives it most accurately.
struct EyeOnEdge {
  int from = 0, to = 0;
  double part = 0;
};
HWY_NOINLINE EyeOnEdge eye_on_edge(const PixelVertex (&corner)[4], double pixels_per_tangent) {
  for (int e = 0; e < 6; ++e) {
    const PixelVertex &a = corner[edge_from[e]], &b = corner[edge_to[e]];
    if (a.w * b.w > 0 || edge_sign(a, b, 0.5, 0.5, pixels_per_tangent) != 0) continue;
    double from = a.w, across = a.w - b.w;
    for (const auto& [p, q] : {std::pair{a.x, b.x}, std::pair{a.y, b.y}})
      if (std::abs(p - q) > std::abs(across)) from = p, across = p - q;
    if (across == 0) return {edge_from[e], edge_from[e], 0};
    return {edge_from[e], edge_to[e], std::clamp(from / across, 0.0, 1.0)};
  }
  return {};
}

/// Candidate pixels of a cell, one per lane.
struct Pixels {
  VD x, y;
  MD in_box;
};

/// The values that are the same for all pixels of a cell, kept in registers as far as possible.
struct CellLanes {
  VD width, inverse_width, left, top, count;  ///< size, position and number of pixels of the box
  VD near_depth, far_depth, tile_left, tile_top, tile_width, bound;
  hn::Vec<hn::RebindToUnsigned<DD>> tet;

  template <int values>
  HWY_INLINE CellLanes(const ProjectedMesh& projected, const Cell<values>& cell, std::uint32_t number,
                       const scene::PixelRect& rect) {
    const DD d;
    width = Set(d, cell.box.width());
    inverse_width = Set(d, 1.0 / cell.box.width());
    left = Set(d, cell.box.x0 + 0.5);
    top = Set(d, cell.box.y0 + 0.5);
    count = Set(d, cell.box.area());
    near_depth = Set(d, projected.near_depth);
    far_depth = Set(d, projected.far_depth);
    tile_left = Set(d, rect.x0 + 0.5);
    tile_top = Set(d, rect.y0 + 0.5);
    tile_width = Set(d, rect.width());
    bound = Set(d, cell.error_bound);
    tet = Set(hn::RebindToUnsigned<DD>(), static_cast<std::uint64_t>(number) << 32);
  }

  /// Returns the candidates base, base + 1... of the box, row by row.
  HWY_INLINE Pixels pixels_from(int base) const {
    const DD d;
    const VD k = Iota(d, base);
    const VD row = Floor((k + Set(d, 0.5)) * inverse_width);  // k < 2^20: exact
    return {NegMulAdd(row, width, k) + left, row + top, k < count};
  }
};

/// Returns the six edge functions at these pixels, with the exact signs.
template <int values>
HWY_INLINE void edge_functions(const Cell<values>& cell, const CellLanes& lanes, const Pixels& pixels, VD (&edge)[6],
                               RasterCounts& counts) {
  const DD d;
  VD qx[4], qy[4];
  for (int i = 0; i < 4; ++i) {
    const VD w = Set(d, cell.corner[i].w);
    qx[i] = NegMulAdd(pixels.x, w, Set(d, cell.corner[i].x));
    qy[i] = NegMulAdd(pixels.y, w, Set(d, cell.corner[i].y));
  }
  VD least = Set(d, HUGE_VAL);
  for (int e = 0; e < 6; ++e) {
    const int a = edge_from[e], b = edge_to[e];
    edge[e] = MulSub(qx[a], qy[b], qx[b] * qy[a]);
    least = Min(least, Abs(edge[e]) + Set(d, cell.certainty[e]));
  }
  const auto uncertain = And(pixels.in_box, least <= lanes.bound);
  if (HWY_UNLIKELY(!AllFalse(d, uncertain))) {
    alignas(64) double x[8], y[8], settled[6][8];
    Store(pixels.x, d, x);
    Store(pixels.y, d, y);
    for (int e = 0; e < 6; ++e) Store(edge[e], d, settled[e]);
    settle_signs(cell, x, y, lane_bits(uncertain), settled, counts);
    for (int e = 0; e < 6; ++e) edge[e] = Load(d, settled[e]);
  }
}

/// Numerators and denominators of depth and values at the pierced face of one orientation, collected face by face.
template <int values>
struct Crossed {
  VD depth_sum, value_sum[values], weight, depth_c, value_c[values];
  MD any;

  HWY_INLINE Crossed() {
    const VD zero = Zero(DD());
    depth_sum = depth_c = zero;
    for (int v = 0; v < values; ++v) value_sum[v] = value_c[v] = zero;
    weight = Set(DD(), 1.0);
    any = zero < zero;
  }
  HWY_INLINE void gather(MD pierced, const Crossed& face) {
    depth_sum = IfThenElse(pierced, face.depth_sum, depth_sum);
    weight = IfThenElse(pierced, face.weight, weight);
    depth_c = IfThenElse(pierced, face.depth_c, depth_c);
    for (int v = 0; v < values; ++v) {
      value_sum[v] = IfThenElse(pierced, face.value_sum[v], value_sum[v]);
      value_c[v] = IfThenElse(pierced, face.value_c[v], value_c[v]);
    }
    any = Or(any, pierced);
  }
};

/// Returns a * (at_a - at_c) + b * (at_b - at_c).
HWY_INLINE VD weighted(VD a, VD b, double at_a, double at_b, double at_c) {
  return MulAdd(a, Set(DD(), at_a - at_c), b * Set(DD(), at_b - at_c));
}

/// The cell's faces that rays pierce from one side (`plus`) and from the other.
template <int values>
HWY_INLINE void cross_faces(const Cell<values>& cell, const VD (&edge)[6], Crossed<values>& plus,
                            Crossed<values>& minus) {
  const DD d;
  const VD zero = Zero(d);
  MD positive[6], negative[6];
  VD weight[6];
  for (int e = 0; e < 6; ++e) {
    positive[e] = edge[e] > zero;
    negative[e] = edge[e] < zero;
    weight[e] = Abs(edge[e]);
  }
  for (int f = 0; f < 4; ++f) {
    if (!cell.pierceable[f]) continue;
    const Face face = faces[f];
    const auto clockwise = And(And(positive[face.bc], negative[face.ac]), positive[face.ab]);
    const auto counter = And(And(negative[face.bc], positive[face.ac]), negative[face.ab]);
    const auto is_plus = face.outward ? clockwise : counter, is_minus = face.outward ? counter : clockwise;
    Crossed<values> here;
    // Values are relative to corner c, so that a face with a single value or depth keeps it bit for bit; a transfer
    // function may have a step at this value.
    const VD a = weight[face.bc], b = weight[face.ac];
    here.depth_c = Set(d, cell.corner[face.c].depth);
    here.depth_sum = weighted(a, b, cell.corner[face.a].depth, cell.corner[face.b].depth, cell.corner[face.c].depth);
    for (int v = 0; v < values; ++v) {
      const double* value = cell.value[v];
      here.value_c[v] = Set(d, value[face.c]);
      here.value_sum[v] = weighted(a, b, value[face.a], value[face.b], value[face.c]);
    }
    here.weight = weight[face.bc] + weight[face.ac] + weight[face.ab];
    plus.gather(is_plus, here);
    minus.gather(is_minus, here);
  }
}

/// The segments of those candidate pixels whose rays pass through the cell.
template <int values>
struct Segments {
  MD hit;
  VD front, back, value_front[values], value_back[values];
};

/// Makes segments from the nearer crossing to the farther one, within the clipping range.
template <int values>
HWY_INLINE Segments<values> segments_between(const CellLanes& lanes, MD hit, const Crossed<values>& plus,
                                             const Crossed<values>& minus) {
  const DD d;
  const VD near_depth = lanes.near_depth, far_depth = lanes.far_depth;
  const VD plus_inverse = Set(d, 1.0) / plus.weight, minus_inverse = Set(d, 1.0) / minus.weight;
  const VD plus_depth = MulAdd(plus.depth_sum, plus_inverse, plus.depth_c);
  const VD minus_depth = MulAdd(minus.depth_sum, minus_inverse, minus.depth_c);
  const auto plus_first = plus_depth <= minus_depth;
  Segments<values> s;
  s.front = Min(plus_depth, minus_depth);
  s.back = Max(plus_depth, minus_depth);
  for (int v = 0; v < values; ++v) {
    const VD at_plus = MulAdd(plus.value_sum[v], plus_inverse, plus.value_c[v]);
    const VD at_minus = MulAdd(minus.value_sum[v], minus_inverse, minus.value_c[v]);
    s.value_front[v] = IfThenElse(plus_first, at_plus, at_minus);
    s.value_back[v] = IfThenElse(plus_first, at_minus, at_plus);
  }
  s.hit = And(hit, And(s.back > near_depth, s.front < far_depth));
  const auto clipped = And(s.hit, Or(s.back > far_depth, s.front < near_depth));
  if (HWY_UNLIKELY(!AllFalse(d, clipped))) {
    const VD front = Max(s.front, near_depth), back = Min(s.back, far_depth);
    for (int v = 0; v < values; ++v) {
      const VD slope = (s.value_back[v] - s.value_front[v]) / (s.back - s.front);
      const VD from = s.value_front[v];
      s.value_front[v] = IfThenElse(s.front < near_depth, MulAdd(front - s.front, slope, from), from);
      s.value_back[v] = IfThenElse(s.back > far_depth, MulAdd(back - s.front, slope, from), s.value_back[v]);
    }
    s.front = front;
    s.back = back;
  }
  return s;
}

template <int values>
HWY_INLINE void append(const Segments<values>& s, const CellLanes& lanes, const Pixels& pixels, RaySegments& out) {
  const DD d;
  const hn::RebindToUnsigned<DD> du;
  const hn::RebindToSigned<DD> di;
  const VD in_tile = MulAdd(pixels.y - lanes.tile_top, lanes.tile_width, pixels.x - lanes.tile_left);
  const auto packed = Or(BitCast(du, ConvertTo(di, in_tile)), lanes.tet);
  const WideLanePacker pack(RebindMask(du, s.hit));
  StoreU(pack(packed), du, out.pixel_and_tet.data() + out.size);
  StoreU(pack(s.front), d, out.front.data() + out.size);
  StoreU(pack(s.back), d, out.back.data() + out.size);
  StoreU(pack(s.value_front[0]), d, out.scalar_front.data() + out.size);
  StoreU(pack(s.value_back[0]), d, out.scalar_back.data() + out.size);
  if constexpr (values == 2) {
    auto& attributed = static_cast<AttributeSegments&>(out);
    StoreU(pack(s.value_front[1]), d, attributed.attribute_front.data() + out.size);
    StoreU(pack(s.value_back[1]), d, attributed.attribute_back.data() + out.size);
  }
  out.size += pack.count();
}

template <int values>
void rasterize_cell(const ProjectedMesh& projected, const Cell<values>& cell, std::uint32_t tet,
                    const scene::PixelRect& rect, RaySegments& out, RasterCounts& counts) {
  const DD d;
  const CellLanes lanes(projected, cell, tet, rect);
  const int count = cell.box.area();
  for (int base = 0; base < count; base += static_cast<int>(hn::Lanes(d))) {
    const Pixels pixels = lanes.pixels_from(base);
    VD edge[6];
    edge_functions(cell, lanes, pixels, edge, counts);
    Crossed<values> plus, minus;
    cross_faces(cell, edge, plus, minus);
    // If there is only one crossing, the eye is on a vertex or an edge of the cell. The faces at this vertex or edge
    // are edge-on for all rays, and the ray begins on them.
    const auto alone = And(pixels.in_box, Xor(plus.any, minus.any));
    if (HWY_UNLIKELY(!AllFalse(d, alone))) {
      const EyeOnEdge eye = eye_on_edge(cell.corner, cell.pixels_per_tangent);
      Crossed<values> here;
      for (int v = 0; v < values; ++v)
        here.value_c[v] =
            Set(d, cell.value[v][eye.from] + (cell.value[v][eye.to] - cell.value[v][eye.from]) * eye.part);
      plus.gather(AndNot(plus.any, alone), here);
      minus.gather(AndNot(minus.any, alone), here);
    }
    const auto hit = And(pixels.in_box, And(plus.any, minus.any));
    if (AllFalse(d, hit)) continue;
    append(segments_between(lanes, hit, plus, minus), lanes, pixels, out);
  }
}

template <class Out>
std::size_t rasterize_cells(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                            const scene::PixelRect& rect, Out& out, RasterCounts& counts) {
  const auto room = static_cast<std::size_t>(rect.area());
  std::size_t taken = 0;
  for (; taken < entries.size() && out.size + room <= out.capacity(); ++taken) {
    const std::uint32_t tet = entries[taken].tet;
    const auto cell = set_up<value_count<Out>>(projected, tet, rect);
    if (!cell.box.empty()) rasterize_cell(projected, cell, tet, rect, out, counts);
  }
  return taken;
}

std::size_t rasterize(const ProjectedMesh& projected, std::span<const TileEntry> entries, const scene::PixelRect& rect,
                      RaySegments& out, RasterCounts& counts) {
  return rasterize_cells(projected, entries, rect, out, counts);
}
std::size_t rasterize_attribute(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                                const scene::PixelRect& rect, AttributeSegments& out, RasterCounts& counts) {
  return rasterize_cells(projected, entries, rect, out, counts);
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(rasterize);
HWY_EXPORT(rasterize_attribute);
HWY_EXPORT(target_name);

std::size_t rasterize_planes(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                             const scene::PixelRect& rect, RaySegments& out, RasterCounts& counts) {
  return HWY_DYNAMIC_DISPATCH(rasterize)(projected, entries, rect, out, counts);
}

std::size_t rasterize_planes(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                             const scene::PixelRect& rect, AttributeSegments& out, RasterCounts& counts) {
  return HWY_DYNAMIC_DISPATCH(rasterize_attribute)(projected, entries, rect, out, counts);
}

std::string instruction_set() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace tessera::projection
#endif  // HWY_ONCE
