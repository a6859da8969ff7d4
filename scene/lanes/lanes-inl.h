// SPDX-License-Identifier: BSD-3-Clause
// The lanes of the kernels: floats and integers of 32 bits, as many as a vector register has, doubles, half as many,
// and the operations on them that Highway 1.0.3 does not have or has only in a slower form. Included once per
// instruction set (Highway's include guard idiom). No other file has intrinsics.
//
// Bits   an operation gives the same bits on every instruction set, unless it states otherwise.

#if defined(TESSERA_SCENE_LANES_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_SCENE_LANES_LANES_INL_H_
#undef TESSERA_SCENE_LANES_LANES_INL_H_
#else
#define TESSERA_SCENE_LANES_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace tessera::scene {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using DF = hn::ScalableTag<float>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VI = hn::Vec<DI>;
using MF = hn::Mask<DF>;
using MI = hn::Mask<DI>;
using DD = hn::ScalableTag<double>;
using VD = hn::Vec<DD>;
using MD = hn::Mask<DD>;

/// Returns the mask as bits, one for each lane.
template <class D>
HWY_INLINE unsigned bits_of_mask(D d, hn::Mask<D> mask) {
  std::uint8_t bits[8] = {0};
  StoreMaskBits(d, mask, bits);
  return MaxLanes(d) > 8 ? bits[0] | static_cast<unsigned>(bits[1]) << 8 : bits[0];
}
HWY_INLINE unsigned lane_bits(MF mask) { return bits_of_mask(DF(), mask); }
HWY_INLINE unsigned lane_bits(MI mask) { return bits_of_mask(DI(), mask); }
HWY_INLINE unsigned lane_bits(MD mask) { return bits_of_mask(DD(), mask); }

/// Returns table[i] for a table of 16 numbers; 0 <= i < 16.
template <class T>
HWY_INLINE hn::Vec<hn::ScalableTag<T>> lookup_16(const T* table, VI i) {
  const hn::ScalableTag<T> d;
  if constexpr (MaxLanes(d) == 16)
    return TableLookupLanes(Load(d, table), IndicesFromVec(d, i));
  else
    return GatherIndex(d, table, i);
}

/// Rounds towards zero. The numbers must be in the range of the integers. Highway's ConvertTo also handles other
/// numbers, which takes four more instructions.
HWY_INLINE VI truncated(VF v) {
#if HWY_TARGET <= HWY_AVX3
  return VI{_mm512_cvttps_epi32(v.raw)};
#elif HWY_TARGET <= HWY_AVX2
  return VI{_mm256_cvttps_epi32(v.raw)};
#else
  return ConvertTo(DI(), v);
#endif
}

/// Returns the smaller one of |a| and |b|.
HWY_INLINE VF least_magnitude(VF a, VF b) {
#if HWY_TARGET <= HWY_AVX3
  constexpr int least_absolute = 2, sign_cleared = 2 << 2;
  return VF{_mm512_range_ps(a.raw, b.raw, least_absolute | sign_cleared)};
#else
  return Min(Abs(a), Abs(b));
#endif
}

/// Treats each lane as two signed 16-bit halves. Returns the product of the low halves plus the product of the high
/// halves.
HWY_INLINE VI dot_of_halves(VI a, VI b) {
#if HWY_TARGET <= HWY_AVX3
  return VI{_mm512_madd_epi16(a.raw, b.raw)};
#elif HWY_TARGET <= HWY_AVX2
  return VI{_mm256_madd_epi16(a.raw, b.raw)};
#elif HWY_TARGET <= HWY_SSSE3
  return VI{_mm_madd_epi16(a.raw, b.raw)};
#else
  const auto low = [](VI v) HWY_ATTR { return ShiftRight<16>(ShiftLeft<16>(v)); };
  return low(a) * low(b) + ShiftRight<16>(a) * ShiftRight<16>(b);
#endif
}

/// Returns a > b in lanes of the mask, false in others.
HWY_INLINE MF greater_where(MF mask, VF a, VF b) {
#if HWY_TARGET <= HWY_AVX3
  return MF{_mm512_mask_cmp_ps_mask(mask.raw, a.raw, b.raw, _CMP_GT_OQ)};
#else
  return And(mask, a > b);
#endif
}

/// Returns `v`, with `bits` set in lanes of the mask.
HWY_INLINE VI or_where(MI mask, VI v, VI bits) {
#if HWY_TARGET <= HWY_AVX3
  return VI{_mm512_mask_or_epi32(v.raw, mask.raw, v.raw, bits.raw)};
#else
  return Or(v, IfThenElseZero(mask, bits));
#endif
}

/// Returns low[i] for i < L and high[i - L] for i >= L, where L is the number of lanes; 0 <= i < 2 L.
HWY_INLINE VF lookup_two(VF low, VF high, VI i) {
#if HWY_TARGET <= HWY_AVX3
  return VF{_mm512_permutex2var_ps(low.raw, i.raw, high.raw)};
#else
  const DF d;
  const DI di;
  const VI lanes = Set(di, static_cast<std::int32_t>(hn::Lanes(di)));
  const auto in_row = IndicesFromVec(d, And(i, lanes - Set(di, 1)));
  return IfThenElse(RebindMask(d, i < lanes), TableLookupLanes(low, in_row), TableLookupLanes(high, in_row));
#endif
}
HWY_INLINE VI lookup_two(VI low, VI high, VI i) {
#if HWY_TARGET <= HWY_AVX3
  return VI{_mm512_permutex2var_epi32(low.raw, i.raw, high.raw)};
#else
  const DF d;
  return BitCast(DI(), lookup_two(BitCast(d, low), BitCast(d, high), i));
#endif
}

#if HWY_TARGET <= HWY_AVX3

/// Loads consecutive floats, each into the lane of its position, for the lanes of the mask; other lanes are those of
/// `otherwise`. Memory at the positions of other lanes is not accessed.
HWY_INLINE VF load_where(unsigned mask, const float* from, VF otherwise) {
  return VF{_mm512_mask_loadu_ps(otherwise.raw, static_cast<__mmask16>(mask), from)};
}

/// Loads as many consecutive floats as the mask has lanes, into these lanes in order; other lanes are those of
/// `otherwise`.
HWY_INLINE VF expand_load(MF mask, const float* from, VF otherwise) {
  return VF{_mm512_mask_expandloadu_ps(otherwise.raw, mask.raw, from)};
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace tessera::scene
HWY_AFTER_NAMESPACE();

#endif
