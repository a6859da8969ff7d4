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

/// Light and optical depth accumulated from front to back.
struct Gathered {
  V color[3], optical_depth;

  /// Adds a piece with mean extinction `kappa` and `source` = light * kappa / (1 - exp(-kappa length)).
  HWY_INLINE void add(V length, V kappa, const V (&source)[3]) {
    const D d;
    const V depth = kappa * length;
    const auto is_thin = depth < Set(d, 1e-8);
    const V absorbed = Neg(Expm1(d, Neg(depth)));
    const V reach = IfThenElse(is_thin, length, absorbed / IfThenElse(is_thin, Set(d, 1.0), kappa));
    const V weight = reach * Exp(d, Neg(optical_depth));
    for (int c = 0; c < 3; ++c) color[c] = MulAdd(weight, source[c], color[c]);
    optical_depth = optical_depth + depth;
  }
};

/// Adds a part of a segment where the function is constant: below the first knot or above the last.
HWY_INLINE void add_outside(const SegmentTable& table, bool by_extinction, V scalar, V length, Gathered& sum) {
  const D d;
  if (AllFalse(d, length > Zero(d))) return;
  const auto is_above = scalar >= Set(d, table.high);  // a function that is a single step is right-continuous
  const auto either = [&](double below, double above)
                          HWY_ATTR { return IfThenElse(is_above, Set(d, above), Set(d, below)); };
  const V kappa = either(table.below.extinction, table.above.extinction);
  const V factor = by_extinction ? kappa : Set(d, 1.0);
  const V source[3] = {factor * either(table.below.red, table.above.red),
                       factor * either(table.below.green, table.above.green),
                       factor * either(table.below.blue, table.above.blue)};
  sum.add(length, kappa, source);
}

/// Adds the part of a segment between the first and the last knot, from the table.
HWY_INLINE void add_inside(const SegmentTable& table, V front, V back, V length, Gathered& sum) {
  const D d;
  const V low = Set(d, table.low), scale = Set(d, table.scale);
  const Place row = place_in((front - low) * scale, table.size);
  const Place column = place_in((back - low) * scale, table.size);
  const V corner = MulAdd(row.below, Set(d, table.size), column.below);
  const V corners[4] = {corner, corner + Set(d, 1), corner + Set(d, table.size), corner + Set(d, table.size + 1)};
  const V row_part[2] = {Set(d, 1.0) - row.part, row.part};
  const V column_part[2] = {Set(d, 1.0) - column.part, column.part};
  V weights[4], kappa = Zero(d);
  for (int i = 0; i < 4; ++i) {
    weights[i] = row_part[i / 2] * column_part[i % 2];
    kappa = MulAdd(weights[i], gather_floats(table.mean_extinction.data(), corners[i]), kappa);
  }
  const V depth = kappa * length, two = Set(d, 2.0);
  const V w = depth * Set(d, table.depths - 1) / (depth + two);
  const Place third = place_in(w, table.depths);
  V source[3] = {Zero(d), Zero(d), Zero(d)};
  for (int i = 0; i < 4; ++i) {
    const V entry = MulAdd(corners[i], Set(d, table.depths), third.below) * Set(d, 4);
    for (int c = 0; c < 3; ++c) {
      const V at_0 = gather_floats(table.light.data() + c, entry);
      const V at_1 = gather_floats(table.light.data() + c + 4, entry);
      source[c] = MulAdd(weights[i], mixed(at_0, at_1, third.part), source[c]);
    }
  }
  sum.add(length, kappa, source);
}

void preintegrated(const SegmentTable& table, scene::Emission emission, SegmentBatch& batch) {
  const D d;
  const V zero = Zero(d), one = Set(d, 1.0), low = Set(d, table.low), high = Set(d, table.high);
  const auto lanes = static_cast<std::size_t>(hn::Lanes(d));
  const bool by_extinction = emission == scene::Emission::absorption;

  for (std::size_t i = 0; i < batch.size; i += lanes) {
    const auto in_batch = Iota(d, 0) < Set(d, static_cast<double>(batch.size - i));
    const V length = IfThenElseZero(in_batch, LoadU(d, &batch.length[i]));
    const V front = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_front[i]));
    const V back = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_back[i]));
    const V front_inside = Min(Max(front, low), high), back_inside = Min(Max(back, low), high);
    // [begin, end] is the part between the first and the last knot, as fractions of the segment. If a segment is
    // entirely outside, all of it counts as the part in front (begin = 1).
    const auto constant = front == back;
    const V change = IfThenElse(constant, one, back - front);
    const auto below = And(front < low, back < low);
    const auto above = And(front > high, back > high);
    const auto outside = Or(Or(below, above), And(constant, low >= high));
    const V begin = IfThenElse(outside, one, Min((front_inside - front) / change, one));
    const V end = IfThenElse(constant, one, Min((back_inside - front) / change, one));

    Gathered sum{{zero, zero, zero}, zero};
    add_outside(table, by_extinction, front, length * begin, sum);
    add_inside(table, front_inside, back_inside, length * Max(end - begin, zero), sum);
    add_outside(table, by_extinction, back, length * (one - Max(begin, end)), sum);
    StoreU(sum.color[0], d, &batch.red[i]);
    StoreU(sum.color[1], d, &batch.green[i]);
    StoreU(sum.color[2], d, &batch.blue[i]);
    StoreU(sum.optical_depth, d, &batch.optical_depth[i]);
    StoreU(Exp(d, Neg(sum.optical_depth)), d, &batch.transmittance[i]);
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
