// SPDX-License-Identifier: BSD-3-Clause
// The field along a stretch of a ray in one voxel, one cubic per lane: its extrema and its crossings of a value.
// Included once per instruction set (Highway's include guard idiom).
//
// What      The trilinear field of a voxel along a ray is a cubic in v in [0, 1] over the stretch. It is determined by
//           its values at the ends and in the middle, and its leading coefficient p_3.
// How       Extrema are the roots of the derivative, in the form without cancellation. If the Bezier coefficients of
//           the derivative have the same sign, as for most cubics, there are none. Between extrema the cubic is
//           monotonic, and Newton's method, restricted to a bracket, finds where it crosses a value.
// Accuracy  A crossing is accurate to 1e-6 of the stretch where the slope is known that well; near an extremum, where
//           the cubic is level, to 3e-4 (lane_error_bound.hpp).
// Bits      A lane's numbers depend on other lanes only through the number of Newton steps.
// Ends      In lanes that are not active the cubic is 0.

#if defined(TESSERA_VOLUME_RAY_CUBIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_RAY_CUBIC_INL_H_
#undef TESSERA_VOLUME_RAY_CUBIC_INL_H_
#else
#define TESSERA_VOLUME_RAY_CUBIC_INL_H_
#endif

#include <hwy/highway.h>

#include "volume/lanes/windows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// One stretch per lane: the field at its ends and in its middle, the cubic's leading coefficient, the length (zero if
/// there is no stretch), the position in the slab where the stretch begins, and its extent in the slab.
struct Piece {
  VF s_0, s_mid, s_1, p_3, length, begin, extent;
};

/// A cubic over v in [0, 1].
struct Cubic {
  VF p_0, p_1, p_2, p_3;
  HWY_INLINE VF at(VF v) const { return MulAdd(MulAdd(MulAdd(p_3, v, p_2), v, p_1), v, p_0); }
  HWY_INLINE VF slope(VF v) const {
    const DF d;
    return MulAdd(MulAdd(Set(d, 3.0f) * p_3, v, p_2 + p_2), v, p_1);
  }
};

/// A position on a cubic, and its value there.
struct CubicPlace {
  VF v, s;
};

/// Returns the positions of the cubic's extrema in (0, 1); 1 for an extremum that does not exist.
HWY_INLINE void find_extrema(const Cubic& c, VF& first, VF& second) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f), three = Set(d, 3.0f);
  const VF discriminant = NegMulAdd(three * c.p_1, c.p_3, c.p_2 * c.p_2);
  const VF root = Sqrt(Max(zero, discriminant));
  const VF q = Neg(c.p_2 + CopySign(root, c.p_2));
  const auto inside = [&](VF v) HWY_ATTR {
    const MF good = And(discriminant > zero, And(v > zero, v < one));
    return IfThenElse(good, v, one);
  };
  const VF a = inside(q / (three * c.p_3)), b = inside(c.p_1 / q);
  first = Min(a, b);
  second = Max(a, b);
}

/// Returns a v between two positions at which the cubic has the value `level`. The cubic must be monotonic between
/// them.
HWY_INLINE VF find_crossing(const Cubic& c, const CubicPlace& from, const CubicPlace& to, VF level, MF wanted) {
  const DF d;
  const VF half = Set(d, 0.5f);
  const MF rises = to.s > from.s;
  VF low = from.v, high = to.v;
  VF v = MulAdd(high - low, (level - from.s) / (to.s - from.s), low);
  for (int step = 0; step < 12; ++step) {
    const VF excess = c.at(v) - level;
    const MF above = excess > Zero(d);
    // A position on the far side becomes the end of the bracket.
    const MF beyond = Xor(above, Not(rises));
    high = IfThenElse(beyond, v, high);
    low = IfThenElse(beyond, low, v);
    VF next = v - excess / c.slope(v);
    const MF kept = And(next >= low, next <= high);
    next = IfThenElse(kept, next, half * (low + high));
    // Newton's method squares its error: after a step of 1e-3 the error is about 1e-6.
    const VF step_done = IfThenElse(kept, Set(d, 1e-3f), Set(d, 1e-6f));
    const MF moving = And(wanted, Abs(next - v) > step_done);
    v = next;
    if (AllFalse(d, moving)) break;
  }
  return v;
}

/// Returns the cubic through a piece's ends and middle; zero in lanes that are not active.
HWY_INLINE Cubic cubic_of(const Piece& piece, MF active) {
  const DF d;
  const VF s_0 = IfThenElseZero(active, piece.s_0), s_mid = IfThenElseZero(active, piece.s_mid),
           s_1 = IfThenElseZero(active, piece.s_1), p_3 = IfThenElseZero(active, piece.p_3);
  Cubic c;
  c.p_0 = s_0;
  c.p_3 = p_3;
  const VF bend = s_0 + s_1 - (s_mid + s_mid);
  c.p_2 = NegMulAdd(Set(d, 1.5f), p_3, bend + bend);
  c.p_1 = s_1 - s_0 - c.p_2 - p_3;
  return c;
}

/// Whether a cubic certainly has no extremum in [0, 1]: the Bezier coefficients of its derivative have the same sign.
HWY_INLINE MF is_monotone(const Cubic& c) {
  const DF d;
  const VF zero = Zero(d);
  const VF d_1 = c.p_1 + c.p_2, d_2 = d_1 + MulAdd(Set(d, 3.0f), c.p_3, c.p_2);
  const VF least = Min(c.p_1, Min(d_1, d_2)), most = Max(c.p_1, Max(d_1, d_2));
  return Not(And(most > zero, least < zero));
}

/// The extrema of a cubic in (0, 1); 1 for an extremum that does not exist. The cubic is monotonic between consecutive
/// extrema.
struct Turns {
  VF first, second;

  HWY_INLINE Turns(const Cubic& c, MF active) : first(Set(DF(), 1.0f)), second(first) {
    if (!AllFalse(DF(), AndNot(is_monotone(c), active))) find_extrema(c, first, second);
  }
  /// Returns the next extremum behind v, or the end.
  HWY_INLINE VF after(VF v) const {
    return IfThenElse(v < first, first, IfThenElse(v < second, second, Set(DF(), 1.0f)));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
