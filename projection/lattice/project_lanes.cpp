// SPDX-License-Identifier: BSD-3-Clause
#include "projection/lattice/project_lanes.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/lattice/project_lanes.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "scene/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
using namespace scene::HWY_NAMESPACE;  // vectors and operations on their lanes

#if HWY_TARGET == HWY_SCALAR
std::size_t project_points(const LinearMap&, const double*, std::size_t, PixelVertex*) { return 0; }
#else
/// A dot product with the same rounding as in glm: no fused sums, left to right.
HWY_INLINE VD along(const double (&axis)[3], VD x, VD y, VD z) {
  const DD d;
  return Set(d, axis[0]) * x + Set(d, axis[1]) * y + Set(d, axis[2]) * z;
}

HWY_INLINE VD on_grid(VD pixel) {
  const DD d;
  const VD scaled = pixel * Set(d, 0x1p32);
  return IfThenElse(IsFinite(scaled), Round(scaled) * Set(d, 0x1p-32), pixel);
}

std::size_t project_points(const LinearMap& map, const double* points, std::size_t count, PixelVertex* out) {
  const DD d;
  const std::size_t lanes = hn::Lanes(d);
  const VD half_width = Set(d, map.half_width), half_height = Set(d, map.half_height);
  const VD scale = Set(d, map.pixels_per_unit);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    VD x, y, z;
    LoadInterleaved3(d, points + 3 * i, x, y, z);
    x = x - Set(d, map.position[0]);
    y = y - Set(d, map.position[1]);
    z = z - Set(d, map.position[2]);
    const VD across = along(map.right, x, y, z) * scale, upward = along(map.up, x, y, z) * scale;
    const VD depth = along(map.forward, x, y, z);
    if (map.perspective)
      StoreInterleaved4(half_width * depth + across, half_height * depth - upward, depth, depth, d, &out[i].x);
    else
      StoreInterleaved4(on_grid(half_width + across), on_grid(half_height - upward), Set(d, 1.0), depth, d, &out[i].x);
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
