// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "integrals/segment_integrator.hpp"
#include "integrals/segment_table.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrals/integrate_preintegrated.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hwy/contrib/math/math-inl.h"
#include "integrals/table_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// What a stretch adds behind what is in front of it.
struct Gathered {
  V color[3], optical_depth;

  /// `kappa`: its mean extinction; `source`: its light * kappa / (1 - exp(-kappa length)).
  HWY_INLINE void add(V length, V kappa, const V (&source)[3]) {
    const D d;
    const V depth = kappa * length;
    const auto is_thin = depth < hn::Set(d, 1e-8);
    const V absorbed = hn::Neg(hn::Expm1(d, hn::Neg(depth)));
    const V reach = hn::IfThenElse(is_thin, length, absorbed / hn::IfThenElse(is_thin, hn::Set(d, 1.0), kappa));
    const V weight = reach * hn::Exp(d, hn::Neg(optical_depth));
    for (int c = 0; c < 3; ++c) color[c] = hn::MulAdd(weight, source[c], color[c]);
    optical_depth = optical_depth + depth;
  }
};

/// Where the function is constant: below the first knot or above the last.
HWY_INLINE void add_outside(const SegmentTable& table, bool by_extinction, V scalar, V length, Gathered& sum) {
  const D d;
  if (hn::AllFalse(d, length > hn::Zero(d))) return;
  const auto is_above = scalar >= hn::Set(d, table.high);  // right-continuous, if it is a step alone
  const auto either = [&](double below, double above)
                          HWY_ATTR { return hn::IfThenElse(is_above, hn::Set(d, above), hn::Set(d, below)); };
  const V kappa = either(table.below.extinction, table.above.extinction);
  const V factor = by_extinction ? kappa : hn::Set(d, 1.0);
  const V source[3] = {factor * either(table.below.red, table.above.red),
                       factor * either(table.below.green, table.above.green),
                       factor * either(table.below.blue, table.above.blue)};
  sum.add(length, kappa, source);
}

/// Between the knots, by the table.
HWY_INLINE void add_inside(const SegmentTable& table, V front, V back, V length, Gathered& sum) {
  const D d;
  const V low = hn::Set(d, table.low), scale = hn::Set(d, table.scale);
  const Place row = place_in((front - low) * scale, table.size);
  const Place column = place_in((back - low) * scale, table.size);
  const V corner = hn::MulAdd(row.below, hn::Set(d, table.size), column.below);
  const V corners[4] = {corner, corner + hn::Set(d, 1), corner + hn::Set(d, table.size),
                        corner + hn::Set(d, table.size + 1)};
  const V row_part[2] = {hn::Set(d, 1.0) - row.part, row.part};
  const V column_part[2] = {hn::Set(d, 1.0) - column.part, column.part};
  V weights[4], kappa = hn::Zero(d);
  for (int i = 0; i < 4; ++i) {
    weights[i] = row_part[i / 2] * column_part[i % 2];
    kappa = hn::MulAdd(weights[i], gather_floats(table.mean_extinction.data(), corners[i]), kappa);
  }
  const V depth = kappa * length, two = hn::Set(d, 2.0);
  const V w = depth * hn::Set(d, table.depths - 1) / (depth + two);
  const Place third = place_in(w, table.depths);
  V source[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  for (int i = 0; i < 4; ++i) {
    const V entry = hn::MulAdd(corners[i], hn::Set(d, table.depths), third.below) * hn::Set(d, 4);
    for (int c = 0; c < 3; ++c) {
      const V at_0 = gather_floats(table.light.data() + c, entry);
      const V at_1 = gather_floats(table.light.data() + c + 4, entry);
      source[c] = hn::MulAdd(weights[i], mixed(at_0, at_1, third.part), source[c]);
    }
  }
  sum.add(length, kappa, source);
}

void preintegrated(const SegmentTable& table, scene::Emission emission, SegmentBatch& batch) {
  const D d;
  const V zero = hn::Zero(d), one = hn::Set(d, 1.0), low = hn::Set(d, table.low), high = hn::Set(d, table.high);
  const auto lanes = static_cast<std::size_t>(hn::Lanes(d));
  const bool by_extinction = emission == scene::Emission::absorption;

  for (std::size_t i = 0; i < batch.size; i += lanes) {
    const auto in_batch = hn::Iota(d, 0) < hn::Set(d, static_cast<double>(batch.size - i));
    const V length = hn::IfThenElseZero(in_batch, hn::LoadU(d, &batch.length[i]));
    const V front = hn::IfThenElseZero(in_batch, hn::LoadU(d, &batch.scalar_front[i]));
    const V back = hn::IfThenElseZero(in_batch, hn::LoadU(d, &batch.scalar_back[i]));
    const V front_inside = hn::Min(hn::Max(front, low), high), back_inside = hn::Min(hn::Max(back, low), high);
    // The stretch between the knots, as shares of the segment. What is all outside lies in front of it.
    const auto constant = front == back;
    const V change = hn::IfThenElse(constant, one, back - front);
    const auto below = hn::And(front < low, back < low);
    const auto above = hn::And(front > high, back > high);
    const auto outside = hn::Or(hn::Or(below, above), hn::And(constant, low >= high));
    const V begin = hn::IfThenElse(outside, one, hn::Min((front_inside - front) / change, one));
    const V end = hn::IfThenElse(constant, one, hn::Min((back_inside - front) / change, one));

    Gathered sum{{zero, zero, zero}, zero};
    add_outside(table, by_extinction, front, length * begin, sum);
    add_inside(table, front_inside, back_inside, length * hn::Max(end - begin, zero), sum);
    add_outside(table, by_extinction, back, length * (one - hn::Max(begin, end)), sum);
    hn::StoreU(sum.color[0], d, &batch.red[i]);
    hn::StoreU(sum.color[1], d, &batch.green[i]);
    hn::StoreU(sum.color[2], d, &batch.blue[i]);
    hn::StoreU(sum.optical_depth, d, &batch.optical_depth[i]);
    hn::StoreU(hn::Exp(d, hn::Neg(sum.optical_depth)), d, &batch.transmittance[i]);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::integrals {
HWY_EXPORT(preintegrated);
void integrate_preintegrated(const SegmentTable& table, scene::Emission emission, SegmentBatch& batch) {
  HWY_DYNAMIC_DISPATCH(preintegrated)(table, emission, batch);
}
}  // namespace tessera::integrals
#endif  // HWY_ONCE
