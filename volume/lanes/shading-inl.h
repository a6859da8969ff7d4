// SPDX-License-Identifier: BSD-3-Clause
// Blinn-Phong shading of stretches inside voxels; included once per instruction set.

#if defined(TESSERA_VOLUME_SHADING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_SHADING_INL_H_
#undef TESSERA_VOLUME_SHADING_INL_H_
#else
#define TESSERA_VOLUME_SHADING_INL_H_
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/frame_view.hpp"
#include "volume/lanes/ray_piece-inl.h"
#include "volume/tile_rays.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// What the field's own colour is multiplied by, and the white light added for each unit of opacity.
struct Lit {
  VF own, white;
  VF error;  ///< of light for each unit of opacity, as the gradient is rounded
};

/// From the gradient along (i, j, k) of the ray's axes. Its length in the world and its products with light and view
/// need no world vectors: the light's come from ShadingView, the view's is the field's change along the ray.
/// `slope_k` is that change per k, `per_length` the shading's unit over the ray's length per k. `noise`: what rounding
/// makes of the gradient's components.
HWY_INLINE Lit shade(const ShadingView& shading, const RayAxes& axes, VF g_i, VF g_j, VF g_k, VF slope_k, VF per_length,
                     VF light_view, float noise) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  const float flip = axes.mirrored ? -1.0f : 1.0f;
  const auto metric = [&](int a, int b) HWY_ATTR { return static_cast<float>(shading.metric[a][b]); };
  const auto times = [&](VF v, float s) HWY_ATTR { return v * Set(d, s); };
  const VF m_i = times(g_i, metric(axes.i, axes.i)) +
                 (times(g_j, 2 * metric(axes.i, axes.j)) + times(g_k, 2 * flip * metric(axes.i, axes.k)));
  const VF m_j = times(g_j, metric(axes.j, axes.j)) + times(g_k, 2 * flip * metric(axes.j, axes.k));
  const VF square = MulAdd(g_i, m_i, MulAdd(g_j, m_j, times(g_k * g_k, metric(axes.k, axes.k))));
  const MF flat = Not(square > zero);
  const VF per_norm = one / Sqrt(IfThenElse(flat, one, square));
  const auto toward = [&](int a) HWY_ATTR { return static_cast<float>(shading.light[a]); };
  const VF n_l =
      per_norm * (times(g_i, toward(axes.i)) + (times(g_j, toward(axes.j)) + times(g_k, flip * toward(axes.k))));
  const VF n_v = Neg(per_norm * (slope_k * per_length));
  const VF half_length = Sqrt(Max(Set(d, 1e-12f), MulAdd(Set(d, 2.0f), light_view, Set(d, 2.0f))));
  const VF n_h = Min(one, Max(Set(d, 1e-6f), Abs((n_l + n_v) / half_length)));
  const VF shine = Exp(d, Set(d, static_cast<float>(shading.shininess)) * Log(d, n_h));
  const VF own =
      MulAdd(Abs(n_l), Set(d, static_cast<float>(shading.diffuse)), Set(d, static_cast<float>(shading.ambient)));
  // A unit normal turns by no more than the noise's part of the gradient, and light changes by this much a turn.
  const double turn = shading.diffuse + shading.specular * std::max(1.0, shading.shininess);
  const float world_noise =
      noise * static_cast<float>(turn * std::sqrt(shading.metric[0][0] + shading.metric[1][1] + shading.metric[2][2]));
  return {IfThenElse(flat, one, own), IfThenElseZero(Not(flat), times(shine, static_cast<float>(shading.specular))),
          IfThenElseZero(Not(flat), times(per_norm, world_noise))};
}

/// Puts a stretch, integrated by itself, behind what there is.
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
