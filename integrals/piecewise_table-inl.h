// SPDX-License-Identifier: BSD-3-Clause
// Finds the interval of a PiecewiseTable that contains each lane's scalar, in double precision. Included once per
// instruction set (Highway's include guard idiom).
//
// What      The number of knots that a ray at scalar s has passed: those at or below s if its scalar increases or is
//           constant, otherwise those below s.
// How       If there are at most 12 knots, all are compared, which is cheaper than the gathers of a binary search.
// Ends      The interval of NaN is 0.

#if defined(TESSERA_INTEGRALS_PIECEWISE_TABLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_INTEGRALS_PIECEWISE_TABLE_INL_H_
#undef TESSERA_INTEGRALS_PIECEWISE_TABLE_INL_H_
#else
#define TESSERA_INTEGRALS_PIECEWISE_TABLE_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "integrals/piecewise_table.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {

using D = hwy::HWY_NAMESPACE::ScalableTag<double>;
using DI = hwy::HWY_NAMESPACE::RebindToSigned<D>;
using V = hwy::HWY_NAMESPACE::Vec<D>;
using VI = hwy::HWY_NAMESPACE::Vec<DI>;

/// Returns the interval that a ray at scalar s enters next.
HWY_INLINE VI locate(const PiecewiseTable& table, V s, hwy::HWY_NAMESPACE::Mask<D> up) {
  namespace hn = hwy::HWY_NAMESPACE;
  const D d;
  const DI di;
  VI count = Zero(di);
  const auto passed = [&](V value) HWY_ATTR { return Or(value < s, And(up, value == s)); };
  if (table.knot_count <= 12) {
    for (std::size_t k = 0; k < table.knot_count; ++k)
      count = count - VecFromMask(di, RebindMask(di, passed(Set(d, table.values[k]))));
    return count;
  }
  for (std::size_t step = (table.values.size() + 1) / 2; step > 0; step /= 2) {
    const auto jump = Set(di, static_cast<std::int64_t>(step));
    const V value = GatherIndex(d, table.values.data(), count + Set(di, static_cast<std::int64_t>(step) - 1));
    count = count + IfThenElseZero(RebindMask(di, passed(value)), jump);
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#endif
