// SPDX-License-Identifier: BSD-3-Clause
// The field along a stretch of a ray in one voxel, a cubic a lane: where it turns and where it crosses a value;
// included once per instruction set.

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
  HWY_INLINE VF at(VF v) const { return HN::MulAdd(HN::MulAdd(HN::MulAdd(p_3, v, p_2), v, p_1), v, p_0); }
  HWY_INLINE VF slope(VF v) const {
    const DF d;
    return HN::MulAdd(HN::MulAdd(HN::Mul(HN::Set(d, 3.0f), p_3), v, HN::Add(p_2, p_2)), v, p_1);
  }
};

/// Places of the cubic's extrema in (0, 1), 1 where there are none.
HWY_INLINE void find_extrema(const Cubic& c, VF& first, VF& second) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f), three = HN::Set(d, 3.0f);
  const VF discriminant = HN::NegMulAdd(HN::Mul(three, c.p_1), c.p_3, HN::Mul(c.p_2, c.p_2));
  const VF root = HN::Sqrt(HN::Max(zero, discriminant));
  const VF q = HN::Neg(HN::Add(c.p_2, HN::CopySign(root, c.p_2)));
  const auto inside = [&](VF v) HWY_ATTR {
    const MF good = HN::And(HN::Gt(discriminant, zero), HN::And(HN::Gt(v, zero), HN::Lt(v, one)));
    return HN::IfThenElse(good, v, one);
  };
  const VF a = inside(HN::Div(q, HN::Mul(three, c.p_3))), b = inside(HN::Div(c.p_1, q));
  first = HN::Min(a, b);
  second = HN::Max(a, b);
}

/// v in [low, high] where the cubic, monotone there, has the value `level`, which lies between its ends'.
HWY_INLINE VF find_crossing(const Cubic& c, VF low, VF high, VF s_low, VF s_high, VF level, MF wanted) {
  const DF d;
  const VF half = HN::Set(d, 0.5f);
  const MF rises = HN::Gt(s_high, s_low);
  VF v = HN::MulAdd(HN::Sub(high, low), HN::Div(HN::Sub(level, s_low), HN::Sub(s_high, s_low)), low);
  for (int step = 0; step < 12; ++step) {
    const VF excess = HN::Sub(c.at(v), level);
    const MF above = HN::Gt(excess, HN::Zero(d));
    // What lies on the far side becomes the bracket's end.
    const MF beyond = HN::Xor(above, HN::Not(rises));
    high = HN::IfThenElse(beyond, v, high);
    low = HN::IfThenElse(beyond, low, v);
    VF next = HN::Sub(v, HN::Div(excess, c.slope(v)));
    const MF kept = HN::And(HN::Ge(next, low), HN::Le(next, high));
    next = HN::IfThenElse(kept, next, HN::Mul(half, HN::Add(low, high)));
    // Newton's method squares its error: after a step of 1e-3 what is left is about 1e-6.
    const VF step_done = HN::IfThenElse(kept, HN::Set(d, 1e-3f), HN::Set(d, 1e-6f));
    const MF moving = HN::And(wanted, HN::Gt(HN::Abs(HN::Sub(next, v)), step_done));
    v = next;
    if (HN::AllFalse(d, moving)) break;
  }
  return v;
}

/// The cubic through a piece's ends and middle; zero where lanes are not active.
HWY_INLINE Cubic cubic_of(const Piece& piece, MF active) {
  const DF d;
  const VF s_0 = HN::IfThenElseZero(active, piece.s_0), s_mid = HN::IfThenElseZero(active, piece.s_mid),
           s_1 = HN::IfThenElseZero(active, piece.s_1), p_3 = HN::IfThenElseZero(active, piece.p_3);
  Cubic c;
  c.p_0 = s_0;
  c.p_3 = p_3;
  const VF bend = HN::Sub(HN::Add(s_0, s_1), HN::Add(s_mid, s_mid));
  c.p_2 = HN::NegMulAdd(HN::Set(d, 1.5f), p_3, HN::Add(bend, bend));
  c.p_1 = HN::Sub(HN::Sub(HN::Sub(s_1, s_0), c.p_2), p_3);
  return c;
}

/// Whether a cubic does not turn in [0, 1] for certain: its slope's Bezier coefficients are of one sign.
HWY_INLINE MF is_monotone(const Cubic& c) {
  const DF d;
  const VF zero = HN::Zero(d);
  const VF d_1 = HN::Add(c.p_1, c.p_2), d_2 = HN::Add(d_1, HN::MulAdd(HN::Set(d, 3.0f), c.p_3, c.p_2));
  const VF least = HN::Min(c.p_1, HN::Min(d_1, d_2)), most = HN::Max(c.p_1, HN::Max(d_1, d_2));
  return HN::Not(HN::And(HN::Lt(least, zero), HN::Gt(most, zero)));
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
