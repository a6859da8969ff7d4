// SPDX-License-Identifier: BSD-3-Clause
// Lanes' values in double precision: two vectors of doubles to one of floats. Included once per instruction set
// (Highway's include guard idiom).
//
// Bits   Those of the same operation on each vector; MulAdd fuses, operators do not.

#if defined(TESSERA_SCENE_LANES_DOUBLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_SCENE_LANES_DOUBLES_INL_H_
#undef TESSERA_SCENE_LANES_DOUBLES_INL_H_
#else
#define TESSERA_SCENE_LANES_DOUBLES_INL_H_
#endif

#include "scene/lanes/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::scene {
namespace HWY_NAMESPACE {

struct Doubles {
  VD low, high;
};
struct DoubleMasks {
  MD low, high;
};

/// Applies f to vectors, for both halves.
template <class Function, class... Args>
HWY_INLINE Doubles in_halves(const Function& f, const Args&... v) {
  return {f(v.low...), f(v.high...)};
}

HWY_INLINE Doubles operator+(Doubles a, Doubles b) { return {a.low + b.low, a.high + b.high}; }
HWY_INLINE Doubles operator-(Doubles a, Doubles b) { return {a.low - b.low, a.high - b.high}; }
HWY_INLINE Doubles operator*(Doubles a, Doubles b) { return {a.low * b.low, a.high * b.high}; }
HWY_INLINE Doubles operator/(Doubles a, Doubles b) { return {a.low / b.low, a.high / b.high}; }
HWY_INLINE Doubles MulAdd(Doubles a, Doubles b, Doubles c) {
  return {MulAdd(a.low, b.low, c.low), MulAdd(a.high, b.high, c.high)};
}
HWY_INLINE Doubles NegMulAdd(Doubles a, Doubles b, Doubles c) {
  return {NegMulAdd(a.low, b.low, c.low), NegMulAdd(a.high, b.high, c.high)};
}

HWY_INLINE DoubleMasks operator>=(Doubles a, Doubles b) { return {a.low >= b.low, a.high >= b.high}; }
HWY_INLINE DoubleMasks And(DoubleMasks a, DoubleMasks b) { return {And(a.low, b.low), And(a.high, b.high)}; }
HWY_INLINE DoubleMasks AndNot(DoubleMasks a, DoubleMasks b) { return {AndNot(a.low, b.low), AndNot(a.high, b.high)}; }
HWY_INLINE Doubles IfThenElseZero(DoubleMasks mask, Doubles v) {
  return {IfThenElseZero(mask.low, v.low), IfThenElseZero(mask.high, v.high)};
}
HWY_INLINE Doubles IfThenElse(DoubleMasks mask, Doubles yes, Doubles no) {
  return {IfThenElse(mask.low, yes.low, no.low), IfThenElse(mask.high, yes.high, no.high)};
}
HWY_INLINE bool all_false(DoubleMasks mask) { return AllFalse(DD(), Or(mask.low, mask.high)); }

HWY_INLINE Doubles doubles(double v) { return {Set(DD(), v), Set(DD(), v)}; }
HWY_INLINE Doubles promote(VF v) {
  const hn::Half<DF> half;
  return {PromoteTo(DD(), LowerHalf(half, v)), PromoteTo(DD(), UpperHalf(half, v))};
}
HWY_INLINE Doubles promote(VI v) {
  const hn::Half<DI> half;
  return {PromoteTo(DD(), LowerHalf(half, v)), PromoteTo(DD(), UpperHalf(half, v))};
}
HWY_INLINE VF demote(Doubles v) {
  const hn::Half<DF> half;
  return Combine(DF(), DemoteTo(half, v.high), DemoteTo(half, v.low));
}
/// Converts whole numbers that fit into 32 bits to integers.
HWY_INLINE VI in_integers(Doubles v) {
  const hn::Half<DI> half;
  return Combine(DI(), DemoteTo(half, v.high), DemoteTo(half, v.low));
}

HWY_INLINE Doubles load(const double* from) {
  const DD d;
  return {Load(d, from), Load(d, from + hn::Lanes(d))};
}
HWY_INLINE Doubles load(const float* from) {
  const hn::Half<DF> half;
  return {PromoteTo(DD(), Load(half, from)), PromoteTo(DD(), Load(half, from + hn::Lanes(half)))};
}
HWY_INLINE void store(Doubles v, double* to) {
  const DD d;
  Store(v.low, d, to), Store(v.high, d, to + hn::Lanes(d));
}
/// Returns numbers[i] in each lane.
HWY_INLINE Doubles gather(const double* numbers, VI i) {
  const hn::RebindToSigned<DD> di;
  const hn::Half<DI> half;
  return {GatherIndex(DD(), numbers, PromoteTo(di, LowerHalf(half, i))),
          GatherIndex(DD(), numbers, PromoteTo(di, UpperHalf(half, i)))};
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::scene
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
