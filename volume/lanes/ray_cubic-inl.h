// SPDX-License-Identifier: BSD-3-Clause
// The field along a stretch of a ray in one voxel, a cubic a lane: where it turns and where it crosses a value;
// included once per instruction set.
//
// What      The trilinear field of a voxel along a ray is a cubic, of v in [0, 1] over the stretch: known by its values
//           at the ends and in the middle, and its leading coefficient, p_3.
// How       It turns at the roots of its slope, in the form without cancellation: where its slope's Bezier coefficients
//           are of one sign it turns nowhere, which most do. Between turns it is monotone, and Newton's method, kept
//           within a bracket, finds where it crosses a value.
// Accuracy  A crossing is right to 1e-6 of the stretch where the slope is known that well: near a turn, where the cubic
//           is level, to 3e-4 (lane_error_bound.hpp).
// Bits      A lane's numbers do not depend on the other lanes but by how many steps Newton's method takes.
// Ends      Lanes that are not active are the cubic 0.

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

/// One stretch a lane. The field at its ends and middle, the cubic's leading coefficient over it, and its length (zero:
/// nothing there). Where in the slab it begins, and how much of the slab it takes.
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

/// A place of a cubic, and its value there.
struct CubicPlace {
  VF v, s;
};

/// Places of the cubic's extrema in (0, 1), 1 where there are none.
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

/// v between two places where the cubic, monotone there, has the value `level`, between theirs.
HWY_INLINE VF find_crossing(const Cubic& c, const CubicPlace& from, const CubicPlace& to, VF level, MF wanted) {
  const DF d;
  const VF half = Set(d, 0.5f);
  const MF rises = to.s > from.s;
  VF low = from.v, high = to.v;
  VF v = MulAdd(high - low, (level - from.s) / (to.s - from.s), low);
  for (int step = 0; step < 12; ++step) {
    const VF excess = c.at(v) - level;
    const MF above = excess > Zero(d);
    // A place on the far side becomes the bracket's end.
    const MF beyond = Xor(above, Not(rises));
    high = IfThenElse(beyond, v, high);
    low = IfThenElse(beyond, low, v);
    VF next = v - excess / c.slope(v);
    const MF kept = And(next >= low, next <= high);
    next = IfThenElse(kept, next, half * (low + high));
    // Newton's method squares its error: after a step of 1e-3 what is left is about 1e-6.
    const VF step_done = IfThenElse(kept, Set(d, 1e-3f), Set(d, 1e-6f));
    const MF moving = And(wanted, Abs(next - v) > step_done);
    v = next;
    if (AllFalse(d, moving)) break;
  }
  return v;
}

/// The cubic through a piece's ends and middle; zero where lanes are not active.
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

/// Whether a cubic does not turn in [0, 1] for certain: its slope's Bezier coefficients are of one sign.
HWY_INLINE MF is_monotone(const Cubic& c) {
  const DF d;
  const VF zero = Zero(d);
  const VF d_1 = c.p_1 + c.p_2, d_2 = d_1 + MulAdd(Set(d, 3.0f), c.p_3, c.p_2);
  const VF least = Min(c.p_1, Min(d_1, d_2)), most = Max(c.p_1, Max(d_1, d_2));
  return Not(And(most > zero, least < zero));
}

/// A cubic's turns in (0, 1), and its end: 1 where there are none. Between two of them it is monotone.
struct Turns {
  VF first, second;

  HWY_INLINE Turns(const Cubic& c, MF active) : first(Set(DF(), 1.0f)), second(first) {
    if (!AllFalse(DF(), AndNot(is_monotone(c), active))) find_extrema(c, first, second);
  }
  /// The next turn behind v, or the end.
  HWY_INLINE VF after(VF v) const {
    return IfThenElse(v < first, first, IfThenElse(v < second, second, Set(DF(), 1.0f)));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
