// SPDX-License-Identifier: BSD-3-Clause
// Lanes of a mask moved to the front; included once per instruction set (Highway's include guard idiom).

#if defined(TESSERA_PROJECTION_PACK_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_PACK_LANES_INL_H_
#undef TESSERA_PROJECTION_PACK_LANES_INL_H_
#else
#define TESSERA_PROJECTION_PACK_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/lattice/pack_lanes.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Packs vectors of 32-bit lanes by one mask. What lies behind the packed lanes is any of the vector's.
class LanePacker {
 public:
  using F = hn::ScalableTag<float>;
  using I = hn::RebindToSigned<F>;

  explicit HWY_INLINE LanePacker(hn::Mask<I> mask) : mask_(mask), count_(CountTrue(I(), mask)) {
#if HWY_TARGET > HWY_AVX3
    std::uint8_t bits[8] = {0};
    StoreMaskBits(I(), mask, bits);
    bits_ = bits[0];
#endif
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  HWY_INLINE hn::Vec<I> operator()(hn::Vec<I> v) const {
#if HWY_TARGET <= HWY_AVX3
    return Compress(v, mask_);
#else
    const I d;
    if constexpr (MaxLanes(I()) == 8) {
      return TableLookupLanes(v, IndicesFromVec(d, Load(d, packing_orders.lanes8[bits_].data())));
    } else {
      const hn::Repartition<std::uint8_t, I> bytes;
      return BitCast(d, TableLookupBytes(BitCast(bytes, v), Load(bytes, packing_orders.bytes4[bits_].data())));
    }
#endif
  }
  HWY_INLINE hn::Vec<F> operator()(hn::Vec<F> v) const { return BitCast(F(), (*this)(BitCast(I(), v))); }

 private:
  hn::Mask<I> mask_;
  std::size_t count_;
#if HWY_TARGET > HWY_AVX3
  unsigned bits_;
#endif
};

/// Packs vectors of 64-bit lanes by one mask, as LanePacker does: a lane is a pair of 32 bits.
class WideLanePacker {
 public:
  using D = hn::ScalableTag<double>;
  using U = hn::RebindToUnsigned<D>;

  explicit HWY_INLINE WideLanePacker(hn::Mask<U> mask) : mask_(mask), count_(CountTrue(U(), mask)) {
#if HWY_TARGET > HWY_AVX3
    std::uint8_t bits[8] = {0};
    StoreMaskBits(U(), mask, bits);
    // Each bit twice: 0 0 b1 b1 b0 b0 ...
    const unsigned b = bits[0];
    pairs_ = 3 * ((b & 1) | (b & 2) << 1 | (b & 4) << 2 | (b & 8) << 3);
#endif
  }

  [[nodiscard]] std::size_t count() const { return count_; }

  HWY_INLINE hn::Vec<U> operator()(hn::Vec<U> v) const {
#if HWY_TARGET <= HWY_AVX3
    return Compress(v, mask_);
#else
    if constexpr (MaxLanes(U()) == 4) {
      const hn::Repartition<std::int32_t, U> d;
      return BitCast(U(),
                     TableLookupLanes(BitCast(d, v), IndicesFromVec(d, Load(d, packing_orders.lanes8[pairs_].data()))));
    } else {
      const hn::Repartition<std::uint8_t, U> bytes;
      return BitCast(U(), TableLookupBytes(BitCast(bytes, v), Load(bytes, packing_orders.bytes4[pairs_].data())));
    }
#endif
  }
  HWY_INLINE hn::Vec<D> operator()(hn::Vec<D> v) const { return BitCast(D(), (*this)(BitCast(U(), v))); }

 private:
  hn::Mask<U> mask_;
  std::size_t count_;
#if HWY_TARGET > HWY_AVX3
  unsigned pairs_;
#endif
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
#if HWY_TARGET == HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// One lane is packed as it is.
class WideLanePacker {
 public:
  using U = hn::ScalableTag<std::uint64_t>;
  explicit WideLanePacker(hn::Mask<U> mask) : count_(CountTrue(U(), mask)) {}
  [[nodiscard]] std::size_t count() const { return count_; }
  template <class V>
  V operator()(V v) const {
    return v;
  }

 private:
  std::size_t count_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif
HWY_AFTER_NAMESPACE();

#endif
