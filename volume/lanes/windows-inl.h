// SPDX-License-Identifier: BSD-3-Clause
// Corner samples of the voxels that contain a packet's lanes. Included once per instruction set (Highway's include
// guard idiom).
//
// What      The samples of two adjacent slices at the corners of each lane's voxel.
// How       A packet's rays are close together: in one slab they need a window of few columns and rows. Two slices of
//           that window fit into vector registers, where one permutation finds a corner of sixteen voxels. (A gather
//           takes fifteen times as long on processors with mitigations against data sampling.) Wider windows, and all
//           windows where vectors are shorter than those of AVX-512, are gathered from memory.
// Ends      An index must be inside the window: callers that gather set lanes without a voxel to element 0.

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
using CL::lookup_two;
using CL::MF;
using CL::truncated;
using CL::VF;
#if HWY_TARGET <= HWY_AVX3
using scene::HWY_NAMESPACE::expand_load;
using scene::HWY_NAMESPACE::load_where;
#endif
using CL::VI;

/// Samples at a voxel's corners: a in the front slice, b in the back slice. The first digit is the position along i,
/// the second along j.
struct Corners {
  VF a00, a10, a01, a11, b00, b10, b01, b11;
};

#if HWY_TARGET <= HWY_AVX3

HWY_INLINE MF within(VF v, VF low, VF high) { return And(v >= low, v < high); }

/// A window of 6 columns and 5 rows per slice, in two registers. Sample (i, j) is element i + 6 j.
class SmallWindow {
 public:
  static constexpr int columns = 6, rows = 5;

  HWY_INLINE SmallWindow(const float* a, const float* b, std::ptrdiff_t pitch) {
    load(a, pitch, a_0_, a_1_);
    load(b, pitch, b_0_, b_1_);
  }
  /// Whether every sample is in [low, high).
  HWY_INLINE bool all_in(float low, float high) const {
    const VF l = Set(DF(), low), h = Set(DF(), high);
    return AllTrue(DF(), And(And(within(a_0_, l, h), within(b_0_, l, h)), And(within(a_1_, l, h), within(b_1_, l, h))));
  }
  HWY_INLINE VI index(VF i, VF j) const { return truncated(MulAdd(j, Set(DF(), columns), i)); }
  HWY_INLINE VF front(VI index) const { return lookup_two(a_0_, a_1_, index); }
  HWY_INLINE VF back(VI index) const { return lookup_two(b_0_, b_1_, index); }
  HWY_INLINE Corners corners(VI i_00) const {
    const DI d;
    const VI i_10 = i_00 + Set(d, 1), i_01 = i_00 + Set(d, columns), i_11 = i_00 + Set(d, columns + 1);
    return {front(i_00), front(i_10), front(i_01), front(i_11), back(i_00), back(i_10), back(i_01), back(i_11)};
  }

 private:
  /// The last two lanes are never looked up, but contain samples too, because all_in() tests all lanes.
  static HWY_INLINE void load(const float* s, std::ptrdiff_t pitch, VF& low, VF& high) {
    const float *const r1 = s + pitch, *const r2 = r1 + pitch, *const r3 = r2 + pitch, *const r4 = r3 + pitch;
    low = load_where(0x003F, s, Zero(DF()));
    low = load_where(0x0FC0, r1 - 6, low);
    low = load_where(0xF000, r2 - 12, low);
    high = load_where(0x0003, r2 + 4, low);
    high = load_where(0x00FC, r3 - 2, high);
    high = load_where(0x3F00, r4 - 8, high);
  }
  VF a_0_, a_1_, b_0_, b_1_;
};

/// A window of 8 columns and 8 rows per slice, in four registers. Sample (i, j) is element i + 8 j.
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
    const VF l = Set(DF(), low), h = Set(DF(), high);
    MF all = And(within(a_[0], l, h), within(b_[0], l, h));
    for (int n = 1; n < 4; ++n) all = And(all, And(within(a_[n], l, h), within(b_[n], l, h)));
    return AllTrue(DF(), all);
  }
  HWY_INLINE VI index(VF i, VF j) const { return truncated(MulAdd(j, Set(DF(), columns), i)); }
  HWY_INLINE VF front(VI index) const { return find(a_, index); }
  HWY_INLINE VF back(VI index) const { return find(b_, index); }
  HWY_INLINE Corners corners(VI i_00) const {
    const DI d;
    const VI i_10 = i_00 + Set(d, 1), i_01 = i_00 + Set(d, columns), i_11 = i_00 + Set(d, columns + 1);
    return {front(i_00), front(i_10), front(i_01), front(i_11), back(i_00), back(i_10), back(i_01), back(i_11)};
  }

 private:
  static HWY_INLINE VF two_rows(const float* s, std::ptrdiff_t pitch) {
    return load_where(0xFF00, s + pitch - 8, load_where(0x00FF, s, Zero(DF())));
  }
  static HWY_INLINE VF find(const VF (&t)[4], VI i) {
    return IfThenElse(RebindMask(DF(), TestBit(i, Set(DI(), 32))), lookup_two(t[2], t[3], i),
                      lookup_two(t[0], t[1], i));
  }
  VF a_[4], b_[4];
};

#endif  // HWY_TARGET <= HWY_AVX3

/// A window of any width, which is read from memory.
class GatherWindow {
 public:
  /// Columns and rows, from where the window begins, that must be in the block.
  static constexpr int columns = 1, rows = 1;

  HWY_INLINE GatherWindow(const float* a, const float* b, std::ptrdiff_t pitch) : a_(a), b_(b), pitch_(pitch) {}
  /// Returns false, because the test would take as long as the integration.
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
