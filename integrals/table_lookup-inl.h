// SPDX-License-Identifier: BSD-3-Clause
// Interpolation in tables of floats, for lanes of doubles. Included once per instruction set (Highway's include guard
// idiom).
//
// What   Finds the entries on either side of a position along an axis, and interpolates linearly between them in double
//        precision.
// Ends   Positions are clamped to the table; NaN becomes the first entry.

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

/// A position on an axis: the entry below the position, and the fraction of the step from this entry to the next.
/// Indices are integers stored as doubles, which SIMD converts to the 32-bit indices of a gather of floats.
struct Place {
  V below, part;
};

/// Returns the position `x`, in entries, clamped to [0, size - 1]; NaN becomes 0. `size` must be at least 2.
HWY_INLINE Place place_in(V x, int size) {
  namespace hn = hwy::HWY_NAMESPACE;
  const D d;
  const V inside = Min(IfThenElseZero(x > Zero(d), x), Set(d, size - 1));
  const V below = Min(Floor(inside), Set(d, size - 2));
  return {below, inside - below};
}

/// Linear interpolation between two entries.
HWY_INLINE V mixed(V at_0, V at_1, V part) {
  namespace hn = hwy::HWY_NAMESPACE;
  return MulAdd(part, at_1 - at_0, at_0);
}

/// Indices must be below 2^31.
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
