// SPDX-License-Identifier: BSD-3-Clause
// Corner samples of the voxels that the lanes of a packet are in; included once per instruction set.
//
// A packet's rays are close together: in one slab they meet a window of few columns and rows. Two slices of that window
// fit into vector registers, where a permutation finds a corner of sixteen voxels in one instruction (a gather takes
// fifteen times as long on processors that guard it against sampling). Wider windows are gathered from memory.

#if defined(TESSERA_VOLUME_WINDOWS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_WINDOWS_INL_H_
#undef TESSERA_VOLUME_WINDOWS_INL_H_
#else
#define TESSERA_VOLUME_WINDOWS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstddef>

#include "integrals/integrate_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
namespace CL = integrals::HWY_NAMESPACE;
using CL::DF;
using CL::DI;
using CL::MF;
using CL::VF;
using CL::VI;

/// Samples at a voxel's corners: a in the front slice, b in the back one; first digit along i, second along j.
struct Corners {
  VF a00, a10, a01, a11, b00, b10, b01, b11;
};

#if HWY_TARGET <= HWY_AVX3

/// 6 columns and 5 rows a slice, in two registers: sample (i, j) is element i + 6 j.
class SmallWindow {
 public:
  static constexpr int columns = 6, rows = 5;

  HWY_INLINE SmallWindow(const float* a, const float* b, std::ptrdiff_t pitch) {
    load(a, pitch, a0_, a1_);
    load(b, pitch, b0_, b1_);
  }
  /// Every sample is in [low, high).
  HWY_INLINE bool all_in(float low, float high) const {
    const __m512 l = _mm512_set1_ps(low), h = _mm512_set1_ps(high);
    const auto in = [&](__mmask16 used, __m512 s) HWY_ATTR {
      return _mm512_mask_cmp_ps_mask(_mm512_mask_cmp_ps_mask(used, s, l, _CMP_GE_OQ), s, h, _CMP_LT_OQ);
    };
    const unsigned low_half = in(0xFFFF, a0_) & in(0xFFFF, b0_), high_half = in(0x3FFF, a1_) & in(0x3FFF, b1_);
    return low_half == 0xFFFF && high_half == 0x3FFF;
  }
  HWY_INLINE VI index(VF i, VF j) const {
    return VI{_mm512_cvttps_epi32(_mm512_fmadd_ps(j.raw, _mm512_set1_ps(columns), i.raw))};
  }
  HWY_INLINE VF front(VI index) const { return VF{_mm512_permutex2var_ps(a0_, index.raw, a1_)}; }
  HWY_INLINE VF back(VI index) const { return VF{_mm512_permutex2var_ps(b0_, index.raw, b1_)}; }
  HWY_INLINE Corners corners(VI index) const {
    const __m512i i00 = index.raw, i10 = _mm512_add_epi32(i00, _mm512_set1_epi32(1)),
                  i01 = _mm512_add_epi32(i00, _mm512_set1_epi32(columns)),
                  i11 = _mm512_add_epi32(i00, _mm512_set1_epi32(columns + 1));
    const auto a = [&](__m512i i) HWY_ATTR { return VF{_mm512_permutex2var_ps(a0_, i, a1_)}; };
    const auto b = [&](__m512i i) HWY_ATTR { return VF{_mm512_permutex2var_ps(b0_, i, b1_)}; };
    return {a(i00), a(i10), a(i01), a(i11), b(i00), b(i10), b(i01), b(i11)};
  }

 private:
  static HWY_INLINE void load(const float* s, std::ptrdiff_t pitch, __m512& low, __m512& high) {
    const float *const r1 = s + pitch, *const r2 = r1 + pitch, *const r3 = r2 + pitch, *const r4 = r3 + pitch;
    low = _mm512_maskz_loadu_ps(0x003F, s);
    low = _mm512_mask_loadu_ps(low, 0x0FC0, r1 - 6);
    low = _mm512_mask_loadu_ps(low, 0xF000, r2 - 12);
    high = _mm512_maskz_loadu_ps(0x0003, r2 + 4);
    high = _mm512_mask_loadu_ps(high, 0x00FC, r3 - 2);
    high = _mm512_mask_loadu_ps(high, 0x3F00, r4 - 8);
  }
  __m512 a0_, a1_, b0_, b1_;
};

/// 8 columns and 8 rows a slice, in four registers: sample (i, j) is element i + 8 j.
class LargeWindow {
 public:
  static constexpr int columns = 8, rows = 8;

  HWY_INLINE LargeWindow(const float* a, const float* b, std::ptrdiff_t pitch) {
    for (int n = 0; n < 4; ++n) {
      a_[n] = two_rows(a + 2 * n * pitch, pitch);
      b_[n] = two_rows(b + 2 * n * pitch, pitch);
    }
  }
  HWY_INLINE bool all_in(float low, float high) const {
    const __m512 l = _mm512_set1_ps(low), h = _mm512_set1_ps(high);
    unsigned all = 0xFFFF;
    for (int n = 0; n < 4; ++n) {
      all &= _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(a_[n], l, _CMP_GE_OQ), a_[n], h, _CMP_LT_OQ);
      all &= _mm512_mask_cmp_ps_mask(_mm512_cmp_ps_mask(b_[n], l, _CMP_GE_OQ), b_[n], h, _CMP_LT_OQ);
    }
    return all == 0xFFFF;
  }
  HWY_INLINE VI index(VF i, VF j) const {
    return VI{_mm512_cvttps_epi32(_mm512_fmadd_ps(j.raw, _mm512_set1_ps(columns), i.raw))};
  }
  HWY_INLINE VF front(VI index) const { return find(a_, index.raw); }
  HWY_INLINE VF back(VI index) const { return find(b_, index.raw); }
  HWY_INLINE Corners corners(VI index) const {
    const __m512i i00 = index.raw, i10 = _mm512_add_epi32(i00, _mm512_set1_epi32(1)),
                  i01 = _mm512_add_epi32(i00, _mm512_set1_epi32(columns)),
                  i11 = _mm512_add_epi32(i00, _mm512_set1_epi32(columns + 1));
    return {find(a_, i00), find(a_, i10), find(a_, i01), find(a_, i11),
            find(b_, i00), find(b_, i10), find(b_, i01), find(b_, i11)};
  }

 private:
  static HWY_INLINE __m512 two_rows(const float* s, std::ptrdiff_t pitch) {
    return _mm512_mask_loadu_ps(_mm512_maskz_loadu_ps(0x00FF, s), 0xFF00, s + pitch - 8);
  }
  static HWY_INLINE VF find(const __m512 (&t)[4], __m512i i) {
    const __m512 low = _mm512_permutex2var_ps(t[0], i, t[1]), high = _mm512_permutex2var_ps(t[2], i, t[3]);
    return VF{_mm512_mask_blend_ps(_mm512_test_epi32_mask(i, _mm512_set1_epi32(32)), low, high)};
  }
  __m512 a_[4], b_[4];
};

#endif  // HWY_TARGET <= HWY_AVX3

/// Any width, from memory.
class GatherWindow {
 public:
  static constexpr int columns = 1, rows = 1;  ///< that must be in the block from where it begins

  HWY_INLINE GatherWindow(const float* a, const float* b, std::ptrdiff_t pitch) : a_(a), b_(b), pitch_(pitch) {}
  /// It would take as long to look as to integrate.
  HWY_INLINE bool all_in(float, float) const { return false; }
  HWY_INLINE VI index(VF i, VF j) const { return ConvertTo(DI(), MulAdd(j, Set(DF(), static_cast<float>(pitch_)), i)); }
  HWY_INLINE VF front(VI index) const { return GatherIndex(DF(), a_, index); }
  HWY_INLINE VF back(VI index) const { return GatherIndex(DF(), b_, index); }
  HWY_INLINE Corners corners(VI index) const {
    const DF d;
    return {GatherIndex(d, a_, index),          GatherIndex(d, a_ + 1, index),
            GatherIndex(d, a_ + pitch_, index), GatherIndex(d, a_ + pitch_ + 1, index),
            GatherIndex(d, b_, index),          GatherIndex(d, b_ + 1, index),
            GatherIndex(d, b_ + pitch_, index), GatherIndex(d, b_ + pitch_ + 1, index)};
  }

 private:
  const float *a_, *b_;
  std::ptrdiff_t pitch_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
