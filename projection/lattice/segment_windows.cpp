// SPDX-License-Identifier: BSD-3-Clause
#include "projection/lattice/segment_windows.hpp"

#include <algorithm>
#include <type_traits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "projection/lattice/segment_windows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tessera::projection {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
std::size_t scatter(const SegmentStream& s, std::size_t, const WindowLists&) { return s.size; }
#else
/// Converts segments to records one vector at a time (a transposition in registers), then stores them one by one: one
/// 16-byte load and store each, in a loop without branches that can be mispredicted, except at its end.
template <bool lit>
std::size_t scatter_as(const SegmentStream& s, std::size_t from, const WindowLists& to) {
  const std::size_t capacity = to.capacity, stride = to.stride;
  LatticeSegment* const lists = to.segments;
  [[maybe_unused]] SegmentLight* const lights = to.lights;
  std::uint32_t* const counts = to.counts;
  const hn::ScalableTag<std::int32_t> d;
  const hn::RebindToFloat<decltype(d)> df;
  constexpr std::size_t most = 16;
  const std::size_t lanes = hn::Lanes(d);
  alignas(64) LatticeSegment records[most];
  for (std::size_t i = from; i < s.size; i += lanes) {
    StoreInterleaved4(LoadU(d, s.front.data() + i), LoadU(d, s.back.data() + i),
                      BitCast(d, LoadU(df, s.scalar_front.data() + i)), BitCast(d, LoadU(df, s.scalar_back.data() + i)),
                      d, reinterpret_cast<std::int32_t*>(records));
    const std::size_t end = s.size - i < lanes ? s.size - i : lanes;
    // Prefetches the approximate destinations of segments 3 vectors ahead (48 with AVX-512); their lists may grow until
    // then. Only every other segment is prefetched, because neighbours in the stream mostly have the same cache line.
    const std::size_t ahead = i + 4 * lanes < s.size ? i + 4 * lanes : s.size;
    for (std::size_t n = i + 3 * lanes; n < ahead; n += 2) {
      const auto pixel = static_cast<std::size_t>(s.pixel[n]);
      __builtin_prefetch(&lists[counts[pixel] * stride + pixel], 1);
    }
    for (std::size_t k = 0; k < end; ++k) {
      const auto pixel = static_cast<std::size_t>(s.pixel[i + k]);
      const std::uint32_t count = counts[pixel];
      if (HWY_UNLIKELY(count == capacity)) return i + k;
      lists[count * stride + pixel] = records[k];
      if constexpr (lit) lights[count * stride + pixel] = {s.own[i + k], s.white[i + k]};
      counts[pixel] = count + 1;
    }
  }
  return s.size;
}

std::size_t scatter(const SegmentStream& s, std::size_t from, const WindowLists& to) {
  return to.lights != nullptr ? scatter_as<true>(s, from, to) : scatter_as<false>(s, from, to);
}
#endif  // HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::projection {
HWY_EXPORT(scatter);

std::size_t SegmentWindows::scatter(const SegmentStream& stream, std::size_t from) {
  return HWY_DYNAMIC_DISPATCH(scatter)(stream, from, {capacity_, stride(), segments_.data(), lights(), counts_.data()});
}

void SegmentWindows::reset(std::size_t pixels, std::size_t capacity, bool lit) {
  pixels_ = pixels;
  capacity_ = capacity;
  lit_ = lit;
  fit();
  clear();
}

void SegmentWindows::grow() {
  capacity_ *= 2;
  fit();
}

void SegmentWindows::fit() {
  const std::size_t elements = capacity_ * stride() + pixel_padding;
  // Lanes read unused elements of lists, so these elements must be valid numbers.
  const auto fit = [&](auto& array) {
    const std::size_t before = array.size();
    if (before >= elements) return;
    array.grow(elements);
    std::fill(array.data() + before, array.data() + elements, std::decay_t<decltype(array[0])>{});
  };
  fit(segments_);
  if (lit_) fit(lights_);
}

}  // namespace tessera::projection
#endif  // HWY_ONCE
