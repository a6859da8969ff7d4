// SPDX-License-Identifier: BSD-3-Clause
// The light on the matter of a batch's segments, one segment per lane. Included once per instruction set (Highway's
// include guard idiom).
//
// What      Computes the SegmentLight of Blinn and Phong's model (tessera/shading.hpp): own = ambient + diffuse |n l|
//           and white = specular |n h|^shininess, with the normal n of the segment's cell, the light l, and the halfway
//           vector h of light and ray. The compositor applies it to the segment's integral
//           (compositor/window_kernel.hpp).
// How       Light is infinitely far away, so `own` is one number per cell. Orthographic rays have one direction, so
//           `white` is one number per cell, too; with perspective, `white` is computed for each segment.
// Accuracy  Double precision, rounded to floats (scene/error_budget.hpp).
// Bits      The light of a segment depends only on its cell and pixel.
// Ends      Without a normal, the color stays unchanged: own = 1, white = 0.

#if defined(TESSERA_PROJECTION_LATTICE_LIGHTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_LIGHTS_INL_H_
#undef TESSERA_PROJECTION_LATTICE_LIGHTS_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_LIGHTS_INL_H_
#endif

#include <cmath>
#include <glm/geometric.hpp>

#include "projection/lattice/lattice_normals-inl.h"
#include "projection/matter_light.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Computes the lights of the segments of batches of cells in one square.
class SegmentLights {
 public:
  SegmentLights(const LatticeView& view, const MaskedRect& pixels)
      : view_(view),
        light_(*view.light),
        rays_(*view.space, pixels.square_x(), pixels.square_y()),
        to_light_{Set(DD(), light_.to_light().x), Set(DD(), light_.to_light().y), Set(DD(), light_.to_light().z)} {
    if (view.perspective) return;
    const glm::dvec3 half = light_.to_light() - glm::normalize(view.space->direction(0, 0));
    const double length = glm::length(half);
    if (length > MatterLight::nothing) halfway_ = half / length;
  }

  /// Sets the lights of a batch's segments, which are those from index `first` on.
  HWY_NOINLINE void set(const CellBatch& batch, std::size_t first, SegmentStream& out) {
    find(batch, cells_of(out, first));
    const DF df;
    for (std::size_t i = first; i < out.size; i += lanes) {
      const VI hit = LoadU(DI(), out.hit.data() + i);
      const VI cell = And(hit, Set(DI(), CellBatch::most - 1));
      StoreU(lookup_16(own_, cell), df, out.own.data() + i);
      StoreU(view_.perspective ? white_of_rays(hit, cell) : lookup_16(white_, cell), df, out.white.data() + i);
    }
  }

 private:
  /// Returns the cells that have segments, one bit each.
  static HWY_INLINE unsigned cells_of(const SegmentStream& out, std::size_t first) {
    const DI d;
    VI cells = Zero(d);
    for (std::size_t i = first; i < out.size; i += lanes) {
      const VI cell = And(LoadU(d, out.hit.data() + i), Set(d, CellBatch::most - 1));
      cells = Or(cells, IfThenElseZero(FirstN(d, out.size - i), Shl(Set(d, 1), cell)));
    }
    alignas(64) std::int32_t of_lane[lanes];
    Store(cells, d, of_lane);
    unsigned all = 0;
    for (const std::int32_t bits : of_lane) all |= static_cast<unsigned>(bits);
    return all;
  }

  HWY_INLINE void find(const CellBatch& batch, unsigned cells) {
    const DD d;
    const scene::Shading& shading = light_.shading();
    const Vectors halfway{Set(d, halfway_.x), Set(d, halfway_.y), Set(d, halfway_.z)};
    with_normals(view_, batch, cells,
                 [&](const std::size_t* of_lane, std::size_t count, const Vectors& normal, const VD(&scalar)[4])
                     HWY_ATTR {
                       const VD one = Set(d, 1);
                       const VD low = Min(Min(scalar[0], scalar[1]), Min(scalar[2], scalar[3])),
                                high = Max(Max(scalar[0], scalar[1]), Max(scalar[2], scalar[3]));
                       const auto level = high - low <= Set(d, MatterLight::nothing) * Max(Abs(low), Abs(high));
                       const auto has = AndNot(level, largest(normal) > Zero(d));
                       const VD n_l = Min(Abs(dot(normal, to_light_)), one), n_h = Min(Abs(dot(normal, halfway)), one);
                       const VD own = MulAdd(Set(d, shading.diffuse), n_l, Set(d, shading.ambient));
                       const VD specular = IfThenElseZero(has, Set(d, shading.specular));
                       alignas(64) double found[6][MaxLanes(DD())];
                       Store(normal.x, d, found[0]), Store(normal.y, d, found[1]), Store(normal.z, d, found[2]);
                       Store(IfThenElse(has, own, one), d, found[3]), Store(specular, d, found[4]);
                       Store(specular * power(n_h), d, found[5]);
                       for (std::size_t lane = 0; lane < count; ++lane) {
                         const std::size_t t = of_lane[lane];
                         for (std::size_t axis = 0; axis < 3; ++axis) normal_[axis][t] = found[axis][lane];
                         own_[t] = static_cast<float>(found[3][lane]);
                         specular_[t] = found[4][lane];
                         white_[t] = static_cast<float>(found[5][lane]);
                       }
                     });
  }

  /// Perspective: returns `white` for hits.
  HWY_INLINE VF white_of_rays(VI hit, VI cell) const {
    const RayLanes ray(rays_, hit);
    const auto white = [&](VD x, VD y, VD z, VD n_x, VD n_y, VD n_z, VD specular) HWY_ATTR {
      const DD d;
      const Vectors direction{x, y, z};
      const Vectors half = to_light_ - direction * (Set(d, 1) / Sqrt(dot(direction, direction)));
      const VD length = Sqrt(dot(half, half));
      const VD n_h = Min(Abs(dot({n_x, n_y, n_z}, half)) / length, Set(d, 1));
      return specular * power(IfThenElseZero(length > Set(d, MatterLight::nothing), n_h));
    };
    return demote(in_halves(white, ray.x, ray.y, ray.z, gather(normal_[0], cell), gather(normal_[1], cell),
                            gather(normal_[2], cell), gather(specular_, cell)));
  }

  /// base^shininess.
  HWY_INLINE VD power(VD base) const {
    const DD d;
    VD result = Set(d, 1);
    if (int e = light_.whole_shininess(); e >= 0) {
      for (; e > 0; e /= 2, base = base * base)
        if (e % 2 != 0) result = result * base;
      return result;
    }
    alignas(64) double numbers[MaxLanes(DD())];
    Store(base, d, numbers);
    for (double& number : numbers) number = std::pow(number, light_.shading().shininess);
    return Load(d, numbers);
  }

  const LatticeView& view_;
  const MatterLight& light_;
  SquareRays rays_;
  Vectors to_light_;
  glm::dvec3 halfway_{0};  ///< orthographic: of length one; zero if the light is straight behind the scene
  // One value per cell.
  alignas(64) float own_[CellBatch::most] = {}, white_[CellBatch::most] = {};
  alignas(64) double normal_[3][CellBatch::most] = {}, specular_[CellBatch::most] = {};
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
