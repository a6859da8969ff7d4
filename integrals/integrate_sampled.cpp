// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "integrals/segment_integrator.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrals/integrate_sampled.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hwy/contrib/math/math-inl.h"
#include "integrals/piecewise_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void sampled(const PiecewiseTable& table, scene::Emission emission, int samples, SegmentBatch& batch) {
  const D d;
  const V zero = Zero(d), one = Set(d, 1.0);
  const auto always = zero == zero;
  const auto lanes = static_cast<std::size_t>(hn::Lanes(d));
  const bool emits_by_extinction = emission == scene::Emission::absorption;

  for (std::size_t i = 0; i < batch.size; i += lanes) {
    const auto in_batch = Iota(d, 0) < Set(d, static_cast<double>(batch.size - i));
    const V step = IfThenElseZero(in_batch, LoadU(d, &batch.length[i])) / Set(d, samples);
    const V front = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_front[i]));
    const V change = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_back[i])) - front;
    V color[3] = {zero, zero, zero}, transmittance = one, optical_depth = zero;
    for (int sample = 0; sample < samples; ++sample) {
      const V s = MulAdd(change, Set(d, (sample + 0.5) / samples), front);
      const VI interval = locate(table, s, always);
      const V from = s - GatherIndex(d, table.base.data(), interval);
      const auto channel = [&](int c) HWY_ATTR {
        return MulAdd(GatherIndex(d, table.channels[c].slope.data(), interval), from,
                      GatherIndex(d, table.channels[c].start.data(), interval));
      };
      const V depth = channel(0) * step;
      const V through = Exp(d, Neg(depth));
      // `source` is int_0^step exp(-kappa t) dt, times kappa for emission by absorption.
      const V absorbed = one - through;
      const auto thin = depth < Set(d, 1e-8);
      const V source =
          emits_by_extinction ? absorbed : IfThenElse(thin, step, step * (absorbed / Max(depth, Set(d, 1e-8))));
      const V weight = transmittance * source;
      for (int c = 0; c < 3; ++c) color[c] = MulAdd(weight, channel(c + 1), color[c]);
      transmittance = transmittance * through;
      optical_depth = optical_depth + depth;
    }
    StoreU(color[0], d, &batch.red[i]);
    StoreU(color[1], d, &batch.green[i]);
    StoreU(color[2], d, &batch.blue[i]);
    StoreU(optical_depth, d, &batch.optical_depth[i]);
    StoreU(transmittance, d, &batch.transmittance[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::integrals {
HWY_EXPORT(sampled);
void integrate_sampled(const PiecewiseTable& table, scene::Emission emission, int samples, SegmentBatch& batch) {
  HWY_DYNAMIC_DISPATCH(sampled)(table, emission, samples, batch);
}
}  // namespace tessera::integrals
#endif  // HWY_ONCE
