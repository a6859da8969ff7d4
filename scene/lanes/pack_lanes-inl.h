// SPDX-License-Identifier: BSD-3-Clause
// Lanes of a mask moved to the front, so that they can be appended to an array. Included once per instruction set
// (Highway's include guard idiom).
//
// What   several vectors packed by one mask: the permutation is found once. The order of the lanes stays.
// How    AVX-512 compresses in a register; other instruction sets permute by a table (scene/lanes/pack_lanes.hpp). A
// pack is
//        stored as a whole vector, because a compressing store is slower on several processors.
// Ends   Lanes after the packed ones are any of the vector's: arrays have a vector of padding.

#if defined(TESSERA_SCENE_LANES_PACK_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_SCENE_LANES_PACK_LANES_INL_H_
#undef TESSERA_SCENE_LANES_PACK_LANES_INL_H_
#else
#define TESSERA_SCENE_LANES_PACK_LANES_INL_H_
#endif

#include "scene/lanes/lanes-inl.h"
#include "scene/lanes/pack_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::scene {
namespace HWY_NAMESPACE {

/// Moves the lanes of a mask to the front, in vectors of 32-bit lanes.
class LanePacker {
 public:
  explicit HWY_INLINE LanePacker(MI mask) : mask_(mask), count_(CountTrue(DI(), mask)) {
#if HWY_TARGET > HWY_AVX3
    bits_ = lane_bits(mask);
#endif
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  HWY_INLINE VI operator()(VI v) const {
#if HWY_TARGET <= HWY_AVX3
    return Compress(v, mask_);
#elif HWY_TARGET == HWY_SCALAR
    return v;
#else
    const DI d;
    if constexpr (MaxLanes(DI()) == 8) {
      return TableLookupLanes(v, IndicesFromVec(d, Load(d, packing_orders.lanes8[bits_].data())));
    } else {
      const hn::Repartition<std::uint8_t, DI> bytes;
      return BitCast(d, TableLookupBytes(BitCast(bytes, v), Load(bytes, packing_orders.bytes4[bits_].data())));
    }
#endif
  }
  HWY_INLINE VF operator()(VF v) const { return BitCast(DF(), (*this)(BitCast(DI(), v))); }

 private:
  MI mask_;
  std::size_t count_;
#if HWY_TARGET > HWY_AVX3
  unsigned bits_;
#endif
};

/// Moves the lanes of a mask to the front, in vectors of 64-bit lanes. Each lane is treated as a pair of 32-bit lanes.
class WideLanePacker {
 public:
  using DU = hn::RebindToUnsigned<DD>;
  using VU = hn::Vec<DU>;

  explicit HWY_INLINE WideLanePacker(hn::Mask<DU> mask) : mask_(mask), count_(CountTrue(DU(), mask)) {
#if HWY_TARGET > HWY_AVX3
    // Each bit is repeated: 0 0 b1 b1 b0 b0 ...
    const unsigned b = bits_of_mask(DU(), mask);
    pairs_ = 3 * ((b & 1) | (b & 2) << 1 | (b & 4) << 2 | (b & 8) << 3);
#endif
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  HWY_INLINE VU operator()(VU v) const {
#if HWY_TARGET <= HWY_AVX3
    return Compress(v, mask_);
#elif HWY_TARGET == HWY_SCALAR
    return v;
#else
    if constexpr (MaxLanes(DU()) == 4) {
      const hn::Repartition<std::int32_t, DU> d;
      return BitCast(DU(),
                     TableLookupLanes(BitCast(d, v), IndicesFromVec(d, Load(d, packing_orders.lanes8[pairs_].data()))));
    } else {
      const hn::Repartition<std::uint8_t, DU> bytes;
      return BitCast(DU(), TableLookupBytes(BitCast(bytes, v), Load(bytes, packing_orders.bytes4[pairs_].data())));
    }
#endif
  }
  HWY_INLINE VD operator()(VD v) const { return BitCast(DD(), (*this)(BitCast(DU(), v))); }

 private:
  hn::Mask<DU> mask_;
  std::size_t count_;
#if HWY_TARGET > HWY_AVX3
  unsigned pairs_;
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::scene
HWY_AFTER_NAMESPACE();

#endif
