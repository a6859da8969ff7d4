// SPDX-License-Identifier: BSD-3-Clause
// Blinn-Phong shading of stretches inside voxels. Included once per instruction set (Highway's include guard idiom).
//
// What      Computes a stretch's own colour times ambient + diffuse |n l|, plus white light of specular |n h|^shininess
//           per unit of the stretch's opacity. n is the direction of the field's gradient in the middle of the stretch;
//           h is halfway between light l and view.
// How       With W from ShadingView, a world gradient is W^T g, the square of its length is g W W^T g, and its product
//           with the light is g W l. Therefore no world vectors are needed. Its product with the view is the field's
//           change along the ray.
// Accuracy  Gradients include the rounding error of the samples (SlabBlock::rest); the error that remains is recorded.
// Ends      Where the gradient is zero, the colour is unchanged and there is no specular light.

#if defined(TESSERA_VOLUME_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_SHADING_INL_H_
#undef TESSERA_VOLUME_SHADING_INL_H_
#else
#define TESSERA_VOLUME_SHADING_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "volume/frame_view.hpp"
#include "volume/lanes/packet_lanes-inl.h"
#include "volume/lanes/ray_piece-inl.h"
#include "volume/tile_rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// The factor for the field's own colour, and the white light that is added per unit of opacity.
struct Lit {
  VF own, white;
  VF error;  ///< error of light per unit of opacity, from rounding of the gradient
};

/// The field's change per voxel along the ray's axes.
struct Gradient {
  VF i, j, k;

  /// The field's change along the ray, per slab.
  HWY_INLINE VF along(const Lanes& lanes) const { return MulAdd(lanes.bx, i, MulAdd(lanes.by, j, k)); }
  /// Returns the gradient, with zeros where it is NaN and outside of `lanes`.
  HWY_INLINE Gradient kept(MF lanes) const {
    const auto finite = [&](VF v) HWY_ATTR { return IfThenElseZero(And(lanes, v == v), v); };
    return {finite(i), finite(j), finite(k)};
  }
};

/// Shading for the gradient g. `along` is the field's change along the ray per shading unit (ShadingView::unit), which
/// is the product of gradient and view. `light_view` is the cosine between light and view.
HWY_INLINE Lit shade(const FrameView& frame, const RayAxes& axes, const Gradient& g, VF along, VF light_view) {
  const DF d;
  const ShadingView& shading = *frame.shading;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  const float flip = axes.mirrored ? -1.0f : 1.0f;
  const auto metric = [&](int a, int b) { return shading.metric[a][b]; };
  const auto times = [&](VF v, float s) HWY_ATTR { return v * Set(d, s); };
  const VF m_i = times(g.i, metric(axes.i, axes.i)) +
                 (times(g.j, 2 * metric(axes.i, axes.j)) + times(g.k, 2 * flip * metric(axes.i, axes.k)));
  const VF m_j = times(g.j, metric(axes.j, axes.j)) + times(g.k, 2 * flip * metric(axes.j, axes.k));
  const VF square = MulAdd(g.i, m_i, MulAdd(g.j, m_j, times(g.k * g.k, metric(axes.k, axes.k))));
  const MF flat = Not(square > zero);
  const VF per_norm = one / Sqrt(IfThenElse(flat, one, square));
  const float* const light = shading.light;
  const VF n_l =
      per_norm * (times(g.i, light[axes.i]) + (times(g.j, light[axes.j]) + times(g.k, flip * light[axes.k])));
  const VF n_v = Neg(per_norm * along);
  const VF half_length = Sqrt(Max(Set(d, 1e-12f), MulAdd(Set(d, 2.0f), light_view, Set(d, 2.0f))));
  const VF n_h = Min(one, Max(Set(d, 1e-6f), Abs((n_l + n_v) / half_length)));
  const VF shine = times(Exp(d, times(Log(d, n_h), shading.shininess)), shading.specular);
  const VF own = MulAdd(Abs(n_l), Set(d, shading.diffuse), Set(d, shading.ambient));
  const VF error = times(per_norm, frame.rest_noise * shading.light_per_noise);
  return {IfThenElse(flat, one, own), IfThenElseZero(Not(flat), shine), IfThenElseZero(Not(flat), error)};
}

/// Composites a stretch that was integrated separately; it is placed behind the accumulated light.
HWY_INLINE void put_behind(const Progress& part, const Lit& lit, Progress& progress) {
  const VF t = progress.transmittance;
  const auto color = [&](VF own, VF& sum)
                         HWY_ATTR { sum = MulAdd(t, MulAdd(lit.own, own, lit.white * part.alpha), sum); };
  color(part.red, progress.red);
  color(part.green, progress.green);
  color(part.blue, progress.blue);
  progress.alpha = MulAdd(t, part.alpha, progress.alpha);
  progress.transmittance = t * part.transmittance;
  progress.optical_depth = progress.optical_depth + part.optical_depth;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
