// SPDX-License-Identifier: BSD-3-Clause
// The light of surfaces' crossings, a crossing a lane; included once per instruction set (Highway's include guard
// idiom).

#if defined(TESSERA_COMPOSITOR_SURFACE_LIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_COMPOSITOR_SURFACE_LIGHTS_INL_H_
#undef TESSERA_COMPOSITOR_SURFACE_LIGHTS_INL_H_
#else
#define TESSERA_COMPOSITOR_SURFACE_LIGHTS_INL_H_
#endif

#include <hwy/highway.h>

#include <vector>

#include "integrals/integrate_lanes-inl.h"
#include "projection/surface_crossings.hpp"
#include "scene/surface_set.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::compositor {
namespace HWY_NAMESPACE {

using namespace integrals::HWY_NAMESPACE;  // vectors, and the integral of a segment a lane
using DD = hn::ScalableTag<double>;
using VD = hn::Vec<DD>;
using HalfF = hn::Half<DF>;
constexpr std::size_t most_lanes = MaxLanes(DI());

/// Lane values in double: two vectors.
struct Doubles {
  VD low, high;
};
HWY_INLINE Doubles load(const double* from) {
  const DD d;
  return {Load(d, from), Load(d, from + hn::Lanes(d))};
}
HWY_INLINE void store(Doubles v, double* to) {
  const DD d;
  Store(v.low, d, to);
  Store(v.high, d, to + hn::Lanes(d));
}
HWY_INLINE Doubles load(const float* from) {
  const DD d;
  const HalfF half;
  return {PromoteTo(d, Load(half, from)), PromoteTo(d, Load(half, from + hn::Lanes(half)))};
}
HWY_INLINE Doubles promote(VF v) {
  const DD d;
  const HalfF half;
  return {PromoteTo(d, LowerHalf(half, v)), PromoteTo(d, UpperHalf(half, v))};
}
HWY_INLINE VF demote(Doubles v) {
  const HalfF half;
  return Combine(DF(), DemoteTo(half, v.high), DemoteTo(half, v.low));
}
/// The crossings' numbers, of marks.
HWY_INLINE VI number_of(VF mark) {
  using Mark = projection::LatticeMark;
  const DI d;
  return ShiftRight<Mark::cosine_bits>(BitCast(d, mark) - Set(d, static_cast<std::int32_t>(Mark::first_bits)));
}

/// scene::SurfaceSet::light() of marks, a crossing a lane.
class SurfaceLights {
 public:
  Doubles red, green, blue, opacity;

  HWY_INLINE SurfaceLights(const scene::SurfaceSet& surfaces, VF mark) {
    using Mark = projection::LatticeMark;
    const DF d;
    const DI di;
    const auto& paint = surfaces.paint_by_number();
    const VI nothing = Set(di, static_cast<std::int32_t>(paint.opacity.size()) - 1);
    const VI number = Min(number_of(mark), nothing);
    const VI code = And(BitCast(di, mark), Set(di, static_cast<std::int32_t>(Mark::cosines)));
    const Doubles cosine = promote(ConvertTo(d, code) / Set(d, static_cast<float>(Mark::cosines)));
    const auto& parts = surfaces.parts_of_light();
    const Doubles power = shine(surfaces, cosine);
    const auto matte = [&](VD c) HWY_ATTR { return Set(DD(), parts.ambient) + Set(DD(), parts.diffuse) * c; };
    const VD specular = Set(DD(), parts.specular);
    const Doubles dull{matte(cosine.low), matte(cosine.high)};
    const Doubles bright{specular * power.low, specular * power.high};
    opacity = of_numbers(paint.opacity, number);
    const auto light = [&](const std::vector<double>& own) HWY_ATTR {
      const Doubles c = of_numbers(own, number);
      return Doubles{(c.low * dull.low + bright.low) * opacity.low, (c.high * dull.high + bright.high) * opacity.high};
    };
    red = light(paint.red), green = light(paint.green), blue = light(paint.blue);
  }

  /// What is seen of a surface and of `behind` it.
  [[nodiscard]] HWY_INLINE Doubles before(const Doubles& of_surface, const Doubles& behind) const {
    const VD one = Set(DD(), 1);
    return {of_surface.low + (one - opacity.low) * behind.low, of_surface.high + (one - opacity.high) * behind.high};
  }

 private:
  static HWY_INLINE Doubles of_numbers(const std::vector<double>& column, VI number) {
    const DD d;
    const hn::RebindToSigned<DD> di;
    const hn::Half<DI> half;
    return {GatherIndex(d, column.data(), PromoteTo(di, LowerHalf(half, number))),
            GatherIndex(d, column.data(), PromoteTo(di, UpperHalf(half, number)))};
  }
  static HWY_INLINE Doubles shine(const scene::SurfaceSet& surfaces, const Doubles& cosine) {
    const DD d;
    if (surfaces.whole_shininess() < 0) return any_shine(surfaces, cosine);
    Doubles base = cosine, power{Set(d, 1), Set(d, 1)};
    for (int exponent = surfaces.whole_shininess(); exponent > 0; exponent /= 2) {
      if (exponent % 2 != 0) power = {power.low * base.low, power.high * base.high};
      base = {base.low * base.low, base.high * base.high};
    }
    return power;
  }
  static HWY_NOINLINE Doubles any_shine(const scene::SurfaceSet& surfaces, const Doubles& cosine) {
    alignas(64) double powers[most_lanes];
    store(cosine, powers);
    for (double& power : powers) power = surfaces.shine(power);
    return load(powers);
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
