#include "projection/project_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/project_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
std::size_t project_points(const LinearMap&, const double*, std::size_t, PixelVertex*) { return 0; }
#else
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

/// A dot product as glm takes it: no fused sums, left to right.
HWY_INLINE V along(const double (&axis)[3], V x, V y, V z) {
  const D d;
  return hn::Add(hn::Add(hn::Mul(hn::Set(d, axis[0]), x), hn::Mul(hn::Set(d, axis[1]), y)),
                 hn::Mul(hn::Set(d, axis[2]), z));
}

HWY_INLINE V on_grid(V pixel) {
  const D d;
  const V scaled = hn::Mul(pixel, hn::Set(d, 0x1p32));
  return hn::IfThenElse(hn::IsFinite(scaled), hn::Mul(hn::Round(scaled), hn::Set(d, 0x1p-32)), pixel);
}

/// The power of two at or below each, and the nearest multiple of one: as pixel_space.cpp has them.
HWY_INLINE V power_of_two(V v) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  return hn::And(v, hn::BitCast(d, hn::Set(du, 0x7ff0000000000000u)));
}
HWY_INLINE V nearest_multiple(V v, V step) {
  const V magic = hn::Mul(hn::Set(D(), 0x1.8p52), step);
  return hn::Sub(hn::Add(v, magic), magic);
}

/// Rounds positions, or directions, as perspective_vertex() of pixel_space.cpp does.
HWY_INLINE void round_perspective(V pixels_per_unit, V& x, V& y, V& w) {
  const D d;
  const auto number = [](double v) HWY_ATTR { return hn::Set(D(), v); };
  const auto larger = [](V a, V b) HWY_ATTR { return hn::Max(hn::Abs(a), hn::Abs(b)); };
  const V px = hn::Div(x, w), py = hn::Div(y, w), reach = larger(px, py);
  const hn::Mask<D> placed = hn::Lt(reach, number(eye_plane_reach));
  V step =
      hn::Max(number(finest_step), hn::Mul(power_of_two(hn::Max(reach, pixels_per_unit)), number(position_precision)));
  if (HWY_UNLIKELY(!hn::AllTrue(d, placed))) {
    step = hn::IfThenElse(placed, step, hn::Mul(power_of_two(larger(x, y)), number(direction_precision)));
    x = hn::IfThenElse(placed, px, x), y = hn::IfThenElse(placed, py, y), w = hn::IfThenElseZero(placed, w);
  } else {
    x = px, y = py;
  }
  x = nearest_multiple(x, step), y = nearest_multiple(y, step);
}

std::size_t project_points(const LinearMap& map, const double* points, std::size_t count, PixelVertex* out) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const V half_width = hn::Set(d, map.half_width), half_height = hn::Set(d, map.half_height);
  const V scale = hn::Set(d, map.pixels_per_unit);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    V x, y, z;
    hn::LoadInterleaved3(d, points + 3 * i, x, y, z);
    x = hn::Sub(x, hn::Set(d, map.position[0]));
    y = hn::Sub(y, hn::Set(d, map.position[1]));
    z = hn::Sub(z, hn::Set(d, map.position[2]));
    const V across = hn::Mul(along(map.right, x, y, z), scale), upward = hn::Mul(along(map.up, x, y, z), scale);
    const V depth = along(map.forward, x, y, z);
    if (map.perspective) {
      V px = hn::Add(hn::Mul(half_width, depth), across), py = hn::Sub(hn::Mul(half_height, depth), upward), w = depth;
      round_perspective(scale, px, py, w);
      hn::StoreInterleaved4(px, py, w, depth, d, &out[i].x);
    } else {
      hn::StoreInterleaved4(on_grid(hn::Add(half_width, across)), on_grid(hn::Sub(half_height, upward)),
                            hn::Set(d, 1.0), depth, d, &out[i].x);
    }
  }
  return i;
}
#endif  // HWY_TARGET == HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(project_points);

std::size_t project_lanes(const LinearMap& map, std::span<const glm::dvec3> p_world, std::span<PixelVertex> out) {
  static_assert(sizeof(glm::dvec3) == 3 * sizeof(double) && sizeof(PixelVertex) == 4 * sizeof(double));
  if (p_world.empty()) return 0;
  return HWY_DYNAMIC_DISPATCH(project_points)(map, &p_world[0].x, p_world.size(), out.data());
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
