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
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f);
  const float flip = axes.mirrored ? -1.0f : 1.0f;
  const auto metric = [&](int a, int b) HWY_ATTR { return static_cast<float>(shading.metric[a][b]); };
  const auto times = [&](VF v, float s) HWY_ATTR { return HN::Mul(v, HN::Set(d, s)); };
  const VF m_i = HN::Add(times(g_i, metric(axes.i, axes.i)), HN::Add(times(g_j, 2 * metric(axes.i, axes.j)),
                                                                     times(g_k, 2 * flip * metric(axes.i, axes.k))));
  const VF m_j = HN::Add(times(g_j, metric(axes.j, axes.j)), times(g_k, 2 * flip * metric(axes.j, axes.k)));
  const VF square = HN::MulAdd(g_i, m_i, HN::MulAdd(g_j, m_j, times(HN::Mul(g_k, g_k), metric(axes.k, axes.k))));
  const MF flat = HN::Not(HN::Gt(square, zero));
  const VF per_norm = HN::Div(one, HN::Sqrt(HN::IfThenElse(flat, one, square)));
  const auto toward = [&](int a) HWY_ATTR { return static_cast<float>(shading.light[a]); };
  const VF n_l = HN::Mul(per_norm, HN::Add(times(g_i, toward(axes.i)),
                                           HN::Add(times(g_j, toward(axes.j)), times(g_k, flip * toward(axes.k)))));
  const VF n_v = HN::Neg(HN::Mul(per_norm, HN::Mul(slope_k, per_length)));
  const VF half_length =
      HN::Sqrt(HN::Max(HN::Set(d, 1e-12f), HN::MulAdd(HN::Set(d, 2.0f), light_view, HN::Set(d, 2.0f))));
  const VF n_h = HN::Min(one, HN::Max(HN::Set(d, 1e-6f), HN::Abs(HN::Div(HN::Add(n_l, n_v), half_length))));
  const VF shine = HN::Exp(d, HN::Mul(HN::Set(d, static_cast<float>(shading.shininess)), HN::Log(d, n_h)));
  const VF own = HN::MulAdd(HN::Abs(n_l), HN::Set(d, static_cast<float>(shading.diffuse)),
                            HN::Set(d, static_cast<float>(shading.ambient)));
  // A unit normal turns by no more than the noise's part of the gradient, and light changes by this much a turn.
  const double turn = shading.diffuse + shading.specular * std::max(1.0, shading.shininess);
  const float world_noise =
      noise * static_cast<float>(turn * std::sqrt(shading.metric[0][0] + shading.metric[1][1] + shading.metric[2][2]));
  return {HN::IfThenElse(flat, one, own),
          HN::IfThenElseZero(HN::Not(flat), times(shine, static_cast<float>(shading.specular))),
          HN::IfThenElseZero(HN::Not(flat), times(per_norm, world_noise))};
}

/// Puts a stretch, integrated by itself, behind what there is.
HWY_INLINE void put_behind(const Progress& part, const Lit& lit, Progress& progress) {
  const VF t = progress.transmittance;
  const auto color = [&](VF own, VF& sum) HWY_ATTR {
    sum = HN::MulAdd(t, HN::MulAdd(lit.own, own, HN::Mul(lit.white, part.alpha)), sum);
  };
  color(part.red, progress.red);
  color(part.green, progress.green);
  color(part.blue, progress.blue);
  progress.alpha = HN::MulAdd(t, part.alpha, progress.alpha);
  progress.transmittance = HN::Mul(t, part.transmittance);
  progress.optical_depth = HN::Add(progress.optical_depth, part.optical_depth);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
