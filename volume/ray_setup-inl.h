// Rays of a tile in index space; included once per instruction set (Highway's include guard idiom).

#if defined(TESSERA_VOLUME_RAY_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_RAY_SETUP_INL_H_
#undef TESSERA_VOLUME_RAY_SETUP_INL_H_
#else
#define TESSERA_VOLUME_RAY_SETUP_INL_H_
#endif

#include <hwy/highway.h>

#include <cmath>

#include "volume/frame_view.hpp"
#include "volume/tile_rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Axis along which a direction goes most, the lowest of equals, times two, plus one if downwards.
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

/// Lays the tile's rays of one axis code out for the kernels; those of others are empty. The light is left alone.
HWY_INLINE void set_up_rays(const FrameView& frame, int x0, int y0, int code, TileRays& out) {
  const PixelRays& rays = *frame.rays;
  const RayAxes axes = RayAxes::of(code);
  const double end_i = static_cast<double>(frame.voxels[static_cast<std::size_t>(axes.i)]),
               end_j = static_cast<double>(frame.voxels[static_cast<std::size_t>(axes.j)]),
               end_k = static_cast<double>(frame.voxels[static_cast<std::size_t>(axes.k)]);
  const double per_unit = 1 / frame.length_unit;
  const bool perspective = rays.tangent_step != 0;
  for (int ray = 0; ray < TileRays::count; ++ray) {
    const double px = x0 + TileRays::pixel_x(ray) + 0.5, py = y0 + TileRays::pixel_y(ray) + 0.5;
    double o[3], d[3];
    for (int a = 0; a < 3; ++a) {
      o[a] = rays.origin[a] + px * rays.origin_x[a] + py * rays.origin_y[a];
      d[a] = rays.direction[a] + px * rays.direction_x[a] + py * rays.direction_y[a];
    }
    const bool here = !perspective || axis_code(d[0], d[1], d[2]) == code;
    const double dk = std::abs(d[axes.k]), ok = axes.mirrored ? end_k - o[axes.k] : o[axes.k];
    const double per_k = 1 / dk;
    const double bx = d[axes.i] * per_k, by = d[axes.j] * per_k;
    const double ax = o[axes.i] - ok * bx, ay = o[axes.j] - ok * by;
    double in = std::max(0.0, ok + rays.near_depth * dk), out_k = std::min(end_k, ok + rays.far_depth * dk);
    const auto clip = [&](double a, double b, double end) HWY_ATTR {
      if (b == 0) {
        if (a < 0 || a > end) out_k = -1;
        return;
      }
      const double low = -a / b, high = (end - a) / b;
      in = std::max(in, b > 0 ? low : high);
      out_k = std::min(out_k, b > 0 ? high : low);
    };
    clip(ax, bx, end_i);
    clip(ay, by, end_j);
    if (!here || !(in < out_k)) in = 1, out_k = 0;
    const double tx = (px - rays.tangent_x0) * rays.tangent_step, ty = (py - rays.tangent_y0) * rays.tangent_step;
    out.ax[ray] = here ? ax : 0, out.bx[ray] = here ? bx : 0;
    out.ay[ray] = here ? ay : 0, out.by[ray] = here ? by : 0;
    out.k_in[ray] = in, out.k_out[ray] = out_k;
    out.depth_0[ray] = -ok * per_k, out.depth_k[ray] = per_k;
    out.length_k[ray] = static_cast<float>(std::sqrt(1 + tx * tx + ty * ty) * per_k * per_unit);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
