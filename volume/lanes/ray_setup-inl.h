// SPDX-License-Identifier: BSD-3-Clause
// Rays of a tile in index space. Included once per instruction set (Highway's include guard idiom).
//
// What      For each ray of one axis code: its positions a + b k along axes i and j, and the interval of k in which it
//           is in the volume, in the view's depth range and on the kept side of clip planes.
// How       In double precision, by linear maps from pixels to origins and directions (PixelRays).
// Accuracy  Rays in a lattice plane, or within 1e-9 voxels of one, are moved to the side that they would be on if they
//           were shifted by an infinitesimal part of a pixel, so that the side does not depend on rounding.
// Ends      k_in >= k_out where a ray has another axis code or misses the volume.

#if defined(TESSERA_VOLUME_RAY_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_RAY_SETUP_INL_H_
#undef TESSERA_VOLUME_RAY_SETUP_INL_H_
#else
#define TESSERA_VOLUME_RAY_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/frame_view.hpp"
#include "volume/tile_rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Returns two times the axis with the largest component of a direction (the lowest of equal axes), plus one if the
/// component is negative.
HWY_INLINE int axis_code(double x, double y, double z) {
  const double ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
  if (ax >= ay && ax >= az) return x < 0 ? 1 : 0;
  if (ay >= az) return y < 0 ? 3 : 2;
  return z < 0 ? 5 : 4;
}

/// Bit n is set if some ray of the tile has axis code n.
HWY_INLINE unsigned axis_codes(const PixelRays& rays, int x0, int y0) {
  if (rays.tangent_step == 0) return 1u << axis_code(rays.direction[0], rays.direction[1], rays.direction[2]);
  unsigned codes = 0;
  for (int ray = 0; ray < TileRays::count; ++ray) {
    const double px = x0 + TileRays::pixel_x(ray) + 0.5, py = y0 + TileRays::pixel_y(ray) + 0.5;
    double d[3];
    for (int a = 0; a < 3; ++a) d[a] = rays.direction[a] + px * rays.direction_x[a] + py * rays.direction_y[a];
    codes |= 1u << axis_code(d[0], d[1], d[2]);
  }
  return codes;
}

/// A ray that stays this close to a lattice plane, in voxels, counts as being in the plane. This covers rounding errors
/// in views along axes.
constexpr double in_plane_within = 1e-9;

/// Returns the offset, in voxels along an axis, that moves these rays to the side on which they would be if they were
/// shifted by (e, e^2) pixels for an infinitesimal e. If this is below the plane, the offset is a float's last place
/// before 1, because positions are floats in [0, 1) within a voxel; if it is above the plane, the offset is the
/// resolution of doubles at 65,536 voxels.
HWY_INLINE double side_of_plane(const PixelRays& rays, bool perspective, int axis) {
  const double by_x = perspective ? rays.direction_x[axis] : rays.origin_x[axis],
               by_y = perspective ? rays.direction_y[axis] : rays.origin_y[axis];
  return (std::abs(by_x) > 1e-9 * std::abs(by_y) ? by_x : by_y) < 0 ? -0x1p-24 : 0x1p-36;
}

/// Whether no ray of the tile can be in a lattice plane across an axis, because no ray is nearly parallel to the plane.
HWY_NOINLINE inline bool crosses_planes(const PixelRays& rays, int x0, int y0, int axis) {
  double least = 0, most = 0, largest = 0;
  for (int corner = 0; corner < 4; ++corner) {
    const int right = corner % 2, down = corner / 2;
    const double px = x0 + right * TileRays::side, py = y0 + down * TileRays::side;
    const glm::dvec3 d = rays.direction + px * rays.direction_x + py * rays.direction_y;
    least = corner == 0 ? d[axis] : std::min(least, d[axis]), most = corner == 0 ? d[axis] : std::max(most, d[axis]);
    largest = std::max({largest, std::abs(d[0]), std::abs(d[1]), std::abs(d[2])});
  }
  // Each ray extends over half a voxel at least.
  return std::max(least, -most) > 4 * in_plane_within * largest;
}

/// Moves rays a + b k that are in a lattice plane by `side`. `reach` is the largest |k| relative to the origin of the
/// rays.
template <class V>
HWY_INLINE void keep_side(V reach, double side, V& a, V& b) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<V> d;
  const V plane = Round(a), within = Set(d, in_plane_within);
  const auto in_plane = And(Abs(b) * reach < within, Abs(a - plane) < within);
  a = IfThenElse(in_plane, plane + Set(d, side), a);
  b = IfThenElse(in_plane, Zero(d), b);
}

/// Clips [in, out] to where a + b k is in [0, end].
template <class V>
HWY_INLINE void clip(V a, V b, double end, V& in, V& out) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<V> d;
  const V zero = Zero(d), one = Set(d, 1.0), last = Set(d, end);
  const auto level = b == zero;
  const auto outside = And(level, Or(a > last, a < zero));
  const V per_b = one / IfThenElse(level, one, b);
  const V first = Neg(a) * per_b, second = (last - a) * per_b;
  in = Max(in, IfThenElse(level, in, Min(first, second)));
  out = Min(out, IfThenElse(level, out, Max(first, second)));
  out = IfThenElse(outside, Set(d, -1.0), out);
}

/// Clips [in, out] to where a + b k >= 0. `inside` states on which side rays are that are in this plane.
template <class V>
HWY_INLINE void clip_half(V a, V b, V reach, bool inside, V& in, V& out) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::DFromV<V> d;
  const V zero = Zero(d), within = Set(d, in_plane_within);
  const auto level = Abs(b) * reach < within;
  const auto in_plane = Abs(a) < within;
  const V side = IfThenElse(in_plane, Set(d, inside ? 1.0 : -1.0), a);
  const V at = Neg(a) / IfThenElse(level, Set(d, 1.0), b);
  const auto rises = b > zero;
  in = IfThenElse(AndNot(level, rises), Max(in, at), in);
  out = IfThenElse(Or(level, rises), out, Min(out, at));
  out = IfThenElse(And(level, side < zero), Set(d, -1.0), out);
}

/// Returns the side of rays that are in a clip plane, by the rule of side_of_plane().
HWY_INLINE bool is_inside(const PixelRays& rays, bool perspective, const KeptSide& kept) {
  double by_x = 0, by_y = 0;
  for (int a = 0; a < 3; ++a) {
    by_x += kept.slope[a] * (perspective ? rays.direction_x[a] : rays.origin_x[a]);
    by_y += kept.slope[a] * (perspective ? rays.direction_y[a] : rays.origin_y[a]);
  }
  return (std::abs(by_x) > 1e-9 * std::abs(by_y) ? by_x : by_y) > 0;
}

/// Sets up the tile's rays of one axis code for the kernels; rays of other codes are empty. Does not change the light.
HWY_NOINLINE inline void set_up_rays(const FrameView& frame, int x0, int y0, int code, TileRays& out) {
  const PixelRays& rays = *frame.rays;
  const RayAxes axes = RayAxes::of(code);
  const double end_i = static_cast<double>(frame.voxels[static_cast<std::size_t>(axes.i)]),
               end_j = static_cast<double>(frame.voxels[static_cast<std::size_t>(axes.j)]),
               end_k = static_cast<double>(frame.voxels[static_cast<std::size_t>(axes.k)]);
  const bool perspective = rays.tangent_step != 0;
  const bool level_i = !crosses_planes(rays, x0, y0, axes.i), level_j = !crosses_planes(rays, x0, y0, axes.j);
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::ScalableTag<double> d;
  const auto set = [&](double v) HWY_ATTR { return Set(d, v); };
  const auto zero = Zero(d), one = set(1.0);
  HWY_ALIGN double column[TileRays::packet_rays], row[TileRays::packet_rays];
  for (int ray = 0; ray < TileRays::packet_rays; ++ray)
    column[ray] = TileRays::pixel_x(ray) + 0.5, row[ray] = TileRays::pixel_y(ray) + 0.5;
  for (int ray = 0; ray < TileRays::count; ray += static_cast<int>(hn::Lanes(d))) {
    const int packet = ray & ~(TileRays::packet_rays - 1), lane = ray - packet;
    const auto px = set(x0 + TileRays::pixel_x(packet)) + Load(d, column + lane),
               py = set(y0 + TileRays::pixel_y(packet)) + Load(d, row + lane);
    const auto along = [&](int a, const glm::dvec3& v, const glm::dvec3& v_x, const glm::dvec3& v_y)
                           HWY_ATTR { return MulAdd(py, set(v_y[a]), MulAdd(px, set(v_x[a]), set(v[a]))); };
    const auto origin = [&](int a) HWY_ATTR { return along(a, rays.origin, rays.origin_x, rays.origin_y); };
    const auto direction = [&](int a) HWY_ATTR { return along(a, rays.direction, rays.direction_x, rays.direction_y); };
    const auto di = direction(axes.i), dj = direction(axes.j), dk_signed = direction(axes.k), o_k = origin(axes.k);
    const auto dk = Abs(dk_signed), ok = axes.mirrored ? set(end_k) - o_k : o_k;
    auto here = zero == zero;
    if (perspective) {
      // As in axis_code(): the lowest of equal axes.
      const auto not_less = [&](auto other, int axis)
                                HWY_ATTR { return axes.k < axis ? dk >= Abs(other) : dk > Abs(other); };
      const auto signed_right = axes.mirrored ? dk_signed < zero : dk_signed >= zero;
      here = And(signed_right, And(not_less(di, axes.i), not_less(dj, axes.j)));
    }
    const auto per_k = one / IfThenElse(here, dk, one);
    auto bx = di * per_k, by = dj * per_k;
    auto ax = NegMulAdd(ok, bx, origin(axes.i)), ay = NegMulAdd(ok, by, origin(axes.j));
    const auto reach = Max(Abs(ok), Abs(set(end_k) - ok));
    if (level_i) keep_side(reach, side_of_plane(rays, perspective, axes.i), ax, bx);
    if (level_j) keep_side(reach, side_of_plane(rays, perspective, axes.j), ay, by);
    auto in = Max(zero, MulAdd(set(rays.near_depth), dk, ok));
    auto out_k = set(end_k);
    if (std::isfinite(rays.far_depth)) out_k = Min(out_k, MulAdd(set(rays.far_depth), dk, ok));
    clip(ax, bx, end_i, in, out_k);
    clip(ay, by, end_j, in, out_k);
    for (const KeptSide& kept : rays.kept) {
      const auto si = set(kept.slope[axes.i]), sj = set(kept.slope[axes.j]);
      const double sk = axes.mirrored ? -kept.slope[axes.k] : kept.slope[axes.k];
      const double at_0 = axes.mirrored ? kept.slope[axes.k] * end_k + kept.constant : kept.constant;
      clip_half(MulAdd(si, ax, MulAdd(sj, ay, set(at_0))), MulAdd(si, bx, MulAdd(sj, by, set(sk))), reach,
                is_inside(rays, perspective, kept), in, out_k);
    }
    const auto kept = And(here, in < out_k);
    const auto tx = (px - set(rays.tangent_x0)) * set(rays.tangent_step),
               ty = (py - set(rays.tangent_y0)) * set(rays.tangent_step);
    const auto length = Sqrt(MulAdd(tx, tx, MulAdd(ty, ty, one))) * per_k * set(1 / frame.length_unit);
    if (frame.shading != nullptr) {
      const double(&l)[3] = frame.shading->light_eye;
      // Towards the eye along the ray: (-tx, ty, 1) in the camera's frame, as y points down the image.
      const auto towards = NegMulAdd(tx, set(l[0]), MulAdd(ty, set(l[1]), set(l[2])));
      const auto cosine = towards / Sqrt(MulAdd(tx, tx, MulAdd(ty, ty, one)));
      Store(DemoteTo(hn::Rebind<float, decltype(d)>(), cosine), hn::Rebind<float, decltype(d)>(), out.light_view + ray);
    }
    Store(IfThenElseZero(here, ax), d, out.ax + ray);
    Store(IfThenElseZero(here, bx), d, out.bx + ray);
    Store(IfThenElseZero(here, ay), d, out.ay + ray);
    Store(IfThenElseZero(here, by), d, out.by + ray);
    Store(IfThenElse(kept, in, one), d, out.k_in + ray);
    Store(IfThenElseZero(kept, out_k), d, out.k_out + ray);
    Store(Neg(ok * per_k), d, out.depth_0 + ray);
    Store(per_k, d, out.depth_k + ray);
    Store(DemoteTo(hn::Rebind<float, decltype(d)>(), length), hn::Rebind<float, decltype(d)>(), out.length_k + ray);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
