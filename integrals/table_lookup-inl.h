// SPDX-License-Identifier: BSD-3-Clause
// Interpolation in tables of floats by lanes of doubles; included once per instruction set (Highway's include guard
// idiom).
//
// What      The entries on either side of a place along an axis, and the line between them, in double precision.
// Ends      Places are kept within the table; NaN is its first entry.

#if defined(TESSERA_INTEGRALS_TABLE_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_INTEGRALS_TABLE_LOOKUP_INL_H_
#undef TESSERA_INTEGRALS_TABLE_LOOKUP_INL_H_
#else
#define TESSERA_INTEGRALS_TABLE_LOOKUP_INL_H_
#endif

#include <hwy/highway.h>

#include "integrals/piecewise_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {

/// Between which two entries of an axis, and where between them. Indices are whole doubles, which SIMD converts to the
/// 32-bit ones that gather floats.
struct Place {
  V below, part;
};

/// `x` in entries, clamped to [0, size - 1]; NaN goes to 0. size >= 2.
HWY_INLINE Place place_in(V x, int size) {
  namespace hn = hwy::HWY_NAMESPACE;
  const D d;
  const V inside = Min(IfThenElseZero(x > Zero(d), x), Set(d, size - 1));
  const V below = Min(Floor(inside), Set(d, size - 2));
  return {below, inside - below};
}

/// Linear between two entries.
HWY_INLINE V mixed(V at_0, V at_1, V part) {
  namespace hn = hwy::HWY_NAMESPACE;
  return MulAdd(part, at_1 - at_0, at_0);
}

/// Indices below 2^31.
HWY_INLINE V gather_floats(const float* table, V index) {
  namespace hn = hwy::HWY_NAMESPACE;
  const D d;
  const hn::Rebind<float, D> df;
  const hn::Rebind<std::int32_t, D> di32;
  return PromoteTo(d, GatherIndex(df, table, DemoteTo(di32, index)));
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#endif
