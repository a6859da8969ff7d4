// SPDX-License-Identifier: BSD-3-Clause
// The light of surface crossings, one crossing per lane. Included once per instruction set (Highway's include guard
// idiom).
//
// What      Computes Blinn-Phong with a light at the eye, as in scene::SurfaceSet::light(). With the cosine c between
//           ray and normal,
//             light = opacity (color (ambient + diffuse c) + specular c^shininess).
//           The mark of a crossing contains c and the number of the surface, which determines color and opacity
//           (LatticeMark).
//           A surface that has the colour of the field gets it from the table of the transfer function.
// Accuracy  Double precision, but colours of the field have single precision; the cosine has the bits of LatticeMark;
//           integer powers are computed by repeated squaring.

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
#include "scene/lanes/doubles-inl.h"
#include "scene/surface_set.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::compositor {
namespace HWY_NAMESPACE {

using namespace integrals::HWY_NAMESPACE;  // vectors, and the integral of a segment a lane
using namespace scene::HWY_NAMESPACE;      // doubles, packing
using integrals::LaneTable;
constexpr std::size_t most_lanes = MaxLanes(DI());

/// Returns the surface numbers of marks.
HWY_INLINE VI number_of(VF mark) {
  using Mark = projection::LatticeMark;
  const DI d;
  return ShiftRight<Mark::cosine_bits>(BitCast(d, mark) - Set(d, static_cast<std::int32_t>(Mark::first_bits)));
}

/// Colours of the transfer function, one per lane.
struct FieldColors {
  Doubles red, green, blue;
};

/// Returns the colours at a scalar per lane. A scalar at a step has the colour above the step. `color_unit` is that of
/// the table.
template <TableForm form>
HWY_INLINE FieldColors field_colors(const Lookup<form>& table, double color_unit, VF scalar) {
  const MF all = scalar == scalar;
  const auto index = table.index(table.locate(scalar, all), all);
  const VF along = scalar - table.at(LaneTable::base, index);
  const auto color = [&](int c) HWY_ATTR {
    return promote(MulAdd(table.at(c + 1, index), along, table.at(c, index))) * doubles(color_unit);
  };
  return {color(LaneTable::red), color(LaneTable::green), color(LaneTable::blue)};
}

/// Same as scene::SurfaceSet::light(), for one mark per lane.
class SurfaceLights {
 public:
  Doubles red, green, blue, opacity;

  /// `field` is only needed if SurfaceSet::shows_field().
  HWY_INLINE SurfaceLights(const scene::SurfaceSet& surfaces, VF mark, const FieldColors* field) {
    using Mark = projection::LatticeMark;
    const DF d;
    const DI di;
    const auto& paint = surfaces.paint_by_number();
    const VI nothing = Set(di, static_cast<std::int32_t>(paint.opacity.size()) - 1);
    const VI number = Min(number_of(mark), nothing);
    const VI code = And(BitCast(di, mark), Set(di, static_cast<std::int32_t>(Mark::cosines)));
    const Doubles cosine = promote(ConvertTo(d, code) / Set(d, static_cast<float>(Mark::cosines)));
    const auto& parts = surfaces.parts_of_light();
    const Doubles matte = doubles(parts.ambient) + doubles(parts.diffuse) * cosine;
    const Doubles highlight = doubles(parts.specular) * shine(surfaces, cosine);
    opacity = gather(paint.opacity.data(), number);
    const auto light = [&](Doubles color) HWY_ATTR { return (color * matte + highlight) * opacity; };
    Doubles r = gather(paint.red.data(), number), g = gather(paint.green.data(), number),
            b = gather(paint.blue.data(), number);
    if (field != nullptr) {
      const Doubles shows = gather(paint.by_field.data(), number);
      r = r + shows * field->red, g = g + shows * field->green, b = b + shows * field->blue;
    }
    red = light(r), green = light(g), blue = light(b);
  }

  /// Composites the light of a surface over `behind`.
  [[nodiscard]] HWY_INLINE Doubles before(const Doubles& of_surface, const Doubles& behind) const {
    return of_surface + (doubles(1) - opacity) * behind;
  }

 private:
  static HWY_INLINE Doubles shine(const scene::SurfaceSet& surfaces, const Doubles& cosine) {
    if (surfaces.whole_shininess() < 0) return any_shine(surfaces, cosine);
    Doubles square = cosine, power = doubles(1);
    for (int exponent = surfaces.whole_shininess(); exponent > 0; exponent /= 2) {
      if (exponent % 2 != 0) power = power * square;
      square = square * square;
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
