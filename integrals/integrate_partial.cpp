// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "integrals/psi_table.hpp"
#include "integrals/segment_integrator.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrals/integrate_partial.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hwy/contrib/math/math-inl.h"
#include "integrals/piecewise_table-inl.h"
#include "integrals/table_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE V psi_of(const PsiTable& table, V a, V b) {
  const D d;
  const V one = Set(d, 1.0), last = Set(d, table.size - 1);
  const auto place = [&](V depth) HWY_ATTR { return place_in(last * (depth / (one + depth)), table.size); };
  const Place row = place(a), column = place(b);
  const V stride = Set(d, table.size);
  const V corner = MulAdd(row.below, stride, column.below);
  const auto at = [&](V index) HWY_ATTR { return gather_floats(table.psi.data(), index); };
  const V near = mixed(at(corner), at(corner + one), column.part);
  const V far_corner = corner + stride;
  const V far = mixed(at(far_corner), at(far_corner + one), column.part);
  return mixed(near, far, row.part);
}

void partial(const PiecewiseTable& table, const PsiTable& psi, SegmentBatch& batch) {
  const D d;
  const DI di;
  const V zero = Zero(d), one = Set(d, 1.0), half = Set(d, 0.5);
  const auto lanes = static_cast<std::size_t>(hn::Lanes(d));
  const auto step_up = Set(di, 1), step_down = Set(di, -1);

  for (std::size_t i = 0; i < batch.size; i += lanes) {
    const auto in_batch = Iota(d, 0) < Set(d, static_cast<double>(batch.size - i));
    const V length = IfThenElseZero(in_batch, LoadU(d, &batch.length[i]));
    const V front = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_front[i]));
    const V back = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_back[i]));
    const auto constant = front == back;
    const auto up = back >= front;
    const V length_per_scalar = length / IfThenElse(constant, one, back - front);

    VI interval = locate(table, front, up);
    V scalar = front, left = length;
    V color[3] = {zero, zero, zero}, transmittance = one, optical_depth = zero;
    auto active = length > zero;
    for (std::size_t pieces = table.above.size(); pieces > 0 && !AllFalse(d, active); --pieces) {
      const auto lookup = [&](const std::vector<double>& column)
                              HWY_ATTR { return GatherIndex(d, column.data(), interval); };
      const V knot = IfThenElse(up, lookup(table.above), lookup(table.below));
      V target = IfThenElse(up, Min(knot, back), Max(knot, back));
      target = IfThenElse(constant, back, target);
      const auto last = target == back;
      const V piece = IfThenElse(last, left, Min(left, (target - scalar) * length_per_scalar));
      const V from = scalar - lookup(table.base), to = target - lookup(table.base);
      const auto channel = [&](int c, V at) HWY_ATTR {
        return MulAdd(lookup(table.channels[c].slope), at, lookup(table.channels[c].start));
      };
      const V a = Max(channel(0, from), zero) * piece, b = Max(channel(0, to), zero) * piece;
      const V depth = half * (a + b);
      const V absorbed = Neg(Expm1(d, Neg(depth)));
      // M - T is between 0 and 1 - T for any monotonic extinction; errors of the table are clamped to that range.
      const V shift = Min(Max(psi_of(psi, a, b) - (one - absorbed), zero), absorbed);
      for (int c = 0; c < 3; ++c) {
        const V near = channel(c + 1, from), change = channel(c + 1, to) - near;
        const V light = MulAdd(change, shift, near * absorbed);
        color[c] = IfThenElse(active, MulAdd(transmittance, light, color[c]), color[c]);
      }
      optical_depth = IfThenElse(active, optical_depth + depth, optical_depth);
      transmittance = IfThenElse(active, transmittance * (one - absorbed), transmittance);
      left = left - piece;
      scalar = target;
      active = AndNot(Or(last, transmittance < Set(d, 1e-10)), active);
      const auto on = RebindMask(di, active);
      interval = interval + IfThenElseZero(on, IfThenElse(RebindMask(di, up), step_up, step_down));
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
HWY_EXPORT(partial);
void integrate_partial(const PiecewiseTable& table, const PsiTable& psi, SegmentBatch& batch) {
  HWY_DYNAMIC_DISPATCH(partial)(table, psi, batch);
}
}  // namespace tessera::integrals
#endif  // HWY_ONCE
