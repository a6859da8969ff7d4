#include "projection/planes_rasterizer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "projection/edge_sign.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/planes_rasterizer.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "projection/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

// Edges by their corners i < j, and faces by their corners a < b < c and the edges bc, ac, ab.
constexpr int edge_from[6] = {0, 0, 0, 1, 1, 2}, edge_to[6] = {1, 2, 3, 2, 3, 3};
struct Face {
  int a, b, c, bc, ac, ab;
  bool outward;  ///< (a, b, c) turns the way that (0, 1, 2) does, seen from outside the cell
};
constexpr Face faces[4] = {
    {0, 1, 2, 3, 1, 0, true}, {0, 1, 3, 4, 2, 0, false}, {0, 2, 3, 5, 2, 1, true}, {1, 2, 3, 5, 4, 3, false}};

/// A cell ready for its pixels.
struct Cell {
  PixelVertex corner[4];
  double scalar[4];
  /// Added to |E| before it is held against the error bound: infinite for an edge without sides, whose ends project to
  /// one point or that holds the eye. Its two faces are edge-on (pierceable = false), so its sign is not needed, and it
  /// would be uncertain at every pixel.
  double certainty[6];
  bool pierceable[4];
  double pixels_per_tangent;  ///< ProjectedMesh's
  double error_bound;         ///< of any E at any candidate pixel
  scene::PixelRect box;
};

// Gaps between exact and computed E: q = X - px * W is rounded once (twice without FMA, when the product px * W is
// rounded too), E = qx_a * qy_b - qx_b * qy_a twice more. The exact one is of lines of sight, which lie beside X and Y.
double error_bound_of(const Cell& cell) {
  constexpr double u = 0x1p-53;
  const double x0 = cell.box.x0, x1 = cell.box.x1, y0 = cell.box.y0, y1 = cell.box.y1;
  double qx = 0, qy = 0, w = 0, beside = 0;
  for (const PixelVertex& v : cell.corner) {
    qx = std::max({qx, std::abs(v.x - x0 * v.w), std::abs(v.x - x1 * v.w)});
    qy = std::max({qy, std::abs(v.y - y0 * v.w), std::abs(v.y - y1 * v.w)});
    w = std::max(w, std::abs(v.w));
    beside = std::max(beside, sight_error(v, cell.pixels_per_tangent, std::max(x1, y1)));
  }
  const double error_x = u * (qx + 2 * x1 * w) + beside, error_y = u * (qy + 2 * y1 * w) + beside;
  return 4 * (qx * error_y + qy * error_x) + 8 * u * qx * qy;
}

HWY_INLINE Cell set_up(const ProjectedMesh& projected, std::uint32_t tet, const scene::PixelRect& rect) {
  Cell cell;
  const scene::TetMeshView& mesh = projected.mesh->mesh();
  const scene::Tet& corners = projected.mesh->tets()[tet];
  for (int i = 0; i < 4; ++i) cell.corner[i] = projected.vertices[corners[i]];
  const bool per_cell = mesh.association == scene::Association::cell;
  for (int i = 0; i < 4; ++i) cell.scalar[i] = mesh.scalars[per_cell ? tet : corners[i]] - projected.scalar_origin;
  cell.box = footprint({cell.corner[0], cell.corner[1], cell.corner[2], cell.corner[3]}, rect);
  if (cell.box.empty()) return cell;
  cell.pixels_per_tangent = projected.pixels_per_tangent;
  for (bool& p : cell.pierceable) p = true;
  for (int e = 0; e < 6; ++e) {
    const PixelVertex &a = cell.corner[edge_from[e]], &b = cell.corner[edge_to[e]];
    // Without sides: both ends on one line of sight, or the eye on the edge (some w <= 0 then).
    const bool one_point = (a.w == b.w && a.x == b.x && a.y == b.y) ||
                           ((a.w <= 0 || b.w <= 0) && edge_sign(a, b, 0.5, 0.5, cell.pixels_per_tangent) == 0);
    cell.certainty[e] = one_point ? HUGE_VAL : 0;
    if (one_point)
      for (int f = 0; f < 4; ++f)
        if (faces[f].bc == e || faces[f].ac == e || faces[f].ab == e) cell.pierceable[f] = false;
  }
  cell.error_bound = error_bound_of(cell);
  return cell;
}

/// |E| of a perspective edge that the ray meets, once the ray is shifted by next to nothing: what it grows by. A face
/// with the eye inside it is met along its plane, where all three E are zero; these are then its weights, and give the
/// eye's depth.
double magnitude_beside(const Cell& cell, int e) {
  const PixelVertex &from = cell.corner[edge_from[e]], &to = cell.corner[edge_to[e]];
  const LineOfSight a = line_of_sight(from, cell.pixels_per_tangent), b = line_of_sight(to, cell.pixels_per_tangent);
  const double by_x = a.y * b.w - a.w * b.y, by_y = a.w * b.x - a.x * b.w;
  const double scale = (a.w == 0 ? 1 : std::abs(from.w)) * (b.w == 0 ? 1 : std::abs(to.w));
  return std::abs(by_x != 0 ? by_x : by_y) * scale * 0x1p-70;
}

/// Replaces the edge functions of uncertain lanes by values of the exact sign (0 where an edge has no sides).
HWY_NOINLINE void settle_signs(const Cell& cell, const double* px, const double* py, std::uint64_t lanes,
                               double (*edges)[8], RasterCounts& counts) {
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = __builtin_ctzll(lanes);
    for (int e = 0; e < 6; ++e) {
      double& value = edges[e][lane];
      if (std::abs(value) > cell.error_bound) continue;
      bool on_edge = false;
      const int sign = edge_sign(cell.corner[edge_from[e]], cell.corner[edge_to[e]], px[lane], py[lane],
                                 cell.pixels_per_tangent, &on_edge);
      ++counts.exact_sign_tests;
      // Within the bound the magnitude is noise. Any magnitude that small is as right; keep it, with the exact sign.
      const double magnitude = on_edge && cell.pixels_per_tangent != 0
                                   ? magnitude_beside(cell, e)
                                   : std::max(std::abs(value), cell.error_bound * 0x1p-20);
      value = sign * std::max(magnitude, 1e-290);
    }
  }
}

/// The scalar at an eye that lies exactly on a vertex or an edge of the cell. Both ends of that edge then lie on one
/// line through the eye, on either side of it, the origin of homogeneous space, so their coordinates are in one ratio;
/// the largest gives it best.
HWY_NOINLINE double scalar_at_eye(const Cell& cell) {
  for (int e = 0; e < 6; ++e) {
    const PixelVertex &a = cell.corner[edge_from[e]], &b = cell.corner[edge_to[e]];
    if (a.w * b.w > 0 || edge_sign(a, b, 0.5, 0.5, cell.pixels_per_tangent) != 0) continue;
    double from = a.w, across = a.w - b.w;
    for (const auto& [p, q] : {std::pair{a.x, b.x}, std::pair{a.y, b.y}})
      if (std::abs(p - q) > std::abs(across)) from = p, across = p - q;
    const double s_a = cell.scalar[edge_from[e]], s_b = cell.scalar[edge_to[e]];
    return across == 0 ? s_a : s_a + (s_b - s_a) * std::clamp(from / across, 0.0, 1.0);
  }
  return cell.scalar[0];
}

/// One way through the cell's surface: depth and scalar where a lane's ray pierces it.
struct Crossing {
  V depth, scalar;
};

/// Numerators and denominators of the pierced face of either orientation, gathered face by face.
struct Crossed {
  V depth_sum, scalar_sum, weight, depth_c, scalar_c;
  hn::Mask<D> any;
};

HWY_INLINE Crossing crossing(const Crossed& x) {
  const V inverse = hn::Div(hn::Set(D(), 1.0), x.weight);
  return {hn::MulAdd(x.depth_sum, inverse, x.depth_c), hn::MulAdd(x.scalar_sum, inverse, x.scalar_c)};
}

HWY_INLINE void gather_face(hn::Mask<D> pierced, V depth_sum, V scalar_sum, V weight, V depth_c, V scalar_c,
                            Crossed& x) {
  x.depth_sum = hn::IfThenElse(pierced, depth_sum, x.depth_sum);
  x.scalar_sum = hn::IfThenElse(pierced, scalar_sum, x.scalar_sum);
  x.weight = hn::IfThenElse(pierced, weight, x.weight);
  x.depth_c = hn::IfThenElse(pierced, depth_c, x.depth_c);
  x.scalar_c = hn::IfThenElse(pierced, scalar_c, x.scalar_c);
  x.any = hn::Or(x.any, pierced);
}

void rasterize_cell(const ProjectedMesh& projected, const Cell& cell, std::uint32_t tet, const scene::PixelRect& rect,
                    RaySegments& out, RasterCounts& counts) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const int count = cell.box.area();
  const V zero = hn::Zero(d), half = hn::Set(d, 0.5), width = hn::Set(d, cell.box.width());
  const V inverse_width = hn::Set(d, 1.0 / cell.box.width());
  const V near_depth = hn::Set(d, projected.near_depth), far_depth = hn::Set(d, projected.far_depth);
  const V left = hn::Set(d, cell.box.x0 + 0.5), top = hn::Set(d, cell.box.y0 + 0.5);
  const V tile_left = hn::Set(d, rect.x0 + 0.5), tile_top = hn::Set(d, rect.y0 + 0.5),
          tile_width = hn::Set(d, rect.width());
  const auto tet_bits = hn::Set(du, static_cast<std::uint64_t>(tet) << 32);
  const V bound = hn::Set(d, cell.error_bound);

  for (int base = 0; base < count; base += lanes) {
    const V k = hn::Iota(d, base);
    const V row = hn::Floor(hn::Mul(hn::Add(k, half), inverse_width));  // k < 2^20: exact
    const V px = hn::Add(hn::NegMulAdd(row, width, k), left), py = hn::Add(row, top);
    const auto in_box = hn::Lt(k, hn::Set(d, count));

    V qx[4], qy[4], edge[6];
    for (int i = 0; i < 4; ++i) {
      const V w = hn::Set(d, cell.corner[i].w);
      qx[i] = hn::NegMulAdd(px, w, hn::Set(d, cell.corner[i].x));
      qy[i] = hn::NegMulAdd(py, w, hn::Set(d, cell.corner[i].y));
    }
    V least = hn::Set(d, HUGE_VAL);
    for (int e = 0; e < 6; ++e) {
      const int a = edge_from[e], b = edge_to[e];
      edge[e] = hn::MulSub(qx[a], qy[b], hn::Mul(qx[b], qy[a]));
      least = hn::Min(least, hn::Add(hn::Abs(edge[e]), hn::Set(d, cell.certainty[e])));
    }
    const auto uncertain = hn::And(in_box, hn::Le(least, bound));
    if (HWY_UNLIKELY(!hn::AllFalse(d, uncertain))) {
      alignas(64) double x[8], y[8], values[6][8];
      std::uint8_t bits[8] = {0};
      hn::StoreMaskBits(d, uncertain, bits);
      hn::Store(px, d, x);
      hn::Store(py, d, y);
      for (int e = 0; e < 6; ++e) hn::Store(edge[e], d, values[e]);
      settle_signs(cell, x, y, bits[0], values, counts);
      for (int e = 0; e < 6; ++e) edge[e] = hn::Load(d, values[e]);
    }

    hn::Mask<D> positive[6], negative[6];
    V weight[6];
    for (int e = 0; e < 6; ++e) {
      positive[e] = hn::Gt(edge[e], zero);
      negative[e] = hn::Lt(edge[e], zero);
      weight[e] = hn::Abs(edge[e]);
    }
    const auto none = hn::Lt(zero, zero);
    const V one = hn::Set(d, 1.0);
    Crossed plus{zero, zero, one, zero, zero, none}, minus{zero, zero, one, zero, zero, none};
    for (int f = 0; f < 4; ++f) {
      if (!cell.pierceable[f]) continue;
      const Face face = faces[f];
      const auto clockwise = hn::And(hn::And(positive[face.bc], negative[face.ac]), positive[face.ab]);
      const auto counter = hn::And(hn::And(negative[face.bc], positive[face.ac]), negative[face.ab]);
      const auto is_plus = face.outward ? clockwise : counter, is_minus = face.outward ? counter : clockwise;
      // Relative to corner c, so that a face of one scalar or depth keeps it to the bit: a transfer function may step
      // there.
      const V depth_c = hn::Set(d, cell.corner[face.c].depth), scalar_c = hn::Set(d, cell.scalar[face.c]);
      const V depth_a = hn::Set(d, cell.corner[face.a].depth - cell.corner[face.c].depth);
      const V depth_b = hn::Set(d, cell.corner[face.b].depth - cell.corner[face.c].depth);
      const V scalar_a = hn::Set(d, cell.scalar[face.a] - cell.scalar[face.c]);
      const V scalar_b = hn::Set(d, cell.scalar[face.b] - cell.scalar[face.c]);
      const V depth_sum = hn::MulAdd(weight[face.bc], depth_a, hn::Mul(weight[face.ac], depth_b));
      const V scalar_sum = hn::MulAdd(weight[face.bc], scalar_a, hn::Mul(weight[face.ac], scalar_b));
      const V total = hn::Add(hn::Add(weight[face.bc], weight[face.ac]), weight[face.ab]);
      gather_face(is_plus, depth_sum, scalar_sum, total, depth_c, scalar_c, plus);
      gather_face(is_minus, depth_sum, scalar_sum, total, depth_c, scalar_c, minus);
    }
    // One crossing alone: the eye lies on a vertex or an edge of the cell, whose faces there are edge-on from
    // everywhere, and the ray begins on them.
    const auto alone = hn::And(in_box, hn::Xor(plus.any, minus.any));
    if (HWY_UNLIKELY(!hn::AllFalse(d, alone))) {
      const V at_eye = hn::Set(d, scalar_at_eye(cell));
      gather_face(hn::AndNot(plus.any, alone), zero, zero, one, zero, at_eye, plus);
      gather_face(hn::AndNot(minus.any, alone), zero, zero, one, zero, at_eye, minus);
    }
    auto hit = hn::And(in_box, hn::And(plus.any, minus.any));
    if (hn::AllFalse(d, hit)) continue;

    const Crossing p = crossing(plus), m = crossing(minus);
    const auto plus_first = hn::Le(p.depth, m.depth);
    V front = hn::Min(p.depth, m.depth), back = hn::Max(p.depth, m.depth);
    V scalar_front = hn::IfThenElse(plus_first, p.scalar, m.scalar);
    V scalar_back = hn::IfThenElse(plus_first, m.scalar, p.scalar);
    hit = hn::And(hit, hn::And(hn::Gt(back, near_depth), hn::Lt(front, far_depth)));
    const auto clipped = hn::And(hit, hn::Or(hn::Lt(front, near_depth), hn::Gt(back, far_depth)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, clipped))) {
      const V slope = hn::Div(hn::Sub(scalar_back, scalar_front), hn::Sub(back, front));
      const V f0 = front, s0 = scalar_front;
      const V f1 = hn::Max(front, near_depth), b1 = hn::Min(back, far_depth);
      scalar_front = hn::IfThenElse(hn::Lt(front, near_depth), hn::MulAdd(hn::Sub(f1, f0), slope, s0), scalar_front);
      scalar_back = hn::IfThenElse(hn::Gt(back, far_depth), hn::MulAdd(hn::Sub(b1, f0), slope, s0), scalar_back);
      front = f1;
      back = b1;
    }

    const V in_tile = hn::MulAdd(hn::Sub(py, tile_top), tile_width, hn::Sub(px, tile_left));
    const auto packed = hn::Or(hn::BitCast(du, hn::ConvertTo(di, in_tile)), tet_bits);
    const WideLanePacker pack(hn::RebindMask(du, hit));
    hn::StoreU(pack(packed), du, out.pixel_and_tet.data() + out.size);
    hn::StoreU(pack(front), d, out.front.data() + out.size);
    hn::StoreU(pack(back), d, out.back.data() + out.size);
    hn::StoreU(pack(scalar_front), d, out.scalar_front.data() + out.size);
    hn::StoreU(pack(scalar_back), d, out.scalar_back.data() + out.size);
    out.size += pack.count();
  }
}

std::size_t rasterize(const ProjectedMesh& projected, std::span<const TileEntry> entries, const scene::PixelRect& rect,
                      RaySegments& out, RasterCounts& counts) {
  const auto room = static_cast<std::size_t>(rect.area());
  std::size_t taken = 0;
  for (; taken < entries.size() && out.size + room <= out.capacity(); ++taken) {
    const std::uint32_t tet = entries[taken].tet;
    const Cell cell = set_up(projected, tet, rect);
    if (!cell.box.empty()) rasterize_cell(projected, cell, tet, rect, out, counts);
  }
  return taken;
}

const char* target_name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(rasterize);
HWY_EXPORT(target_name);

std::size_t rasterize_planes(const ProjectedMesh& projected, std::span<const TileEntry> entries,
                             const scene::PixelRect& rect, RaySegments& out, RasterCounts& counts) {
  return HWY_DYNAMIC_DISPATCH(rasterize)(projected, entries, rect, out, counts);
}

std::string instruction_set() { return HWY_DYNAMIC_DISPATCH(target_name)(); }

}  // namespace tessera::projection
#endif  // HWY_ONCE
