// SPDX-License-Identifier: BSD-3-Clause
// Segments on the lattice, one per lane. Included once per instruction set (Highway's include guard idiom).

#if defined(TESSERA_PROJECTION_SEGMENT_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_SEGMENT_LANES_INL_H_
#undef TESSERA_PROJECTION_SEGMENT_LANES_INL_H_
#else
#define TESSERA_PROJECTION_SEGMENT_LANES_INL_H_
#endif

#include "projection/lattice/segment_windows.hpp"
#include "scene/lanes/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {
using namespace scene::HWY_NAMESPACE;  // vectors and operations on their lanes

/// LatticeSegments, one per lane.
struct SegmentLanes {
  VI front, back;
  VF scalar_front, scalar_back;
};

/// Appends the segments of the lanes of `hit`: packed in registers and stored as whole vectors.
HWY_INLINE void append(MF hit, VI pixel, const SegmentLanes& segments, SegmentStream& out) {
  const DI d;
  const DF df;
  const LanePacker pack(RebindMask(d, hit));
  StoreU(pack(pixel), d, out.pixel.data() + out.size);
  StoreU(pack(segments.front), d, out.front.data() + out.size);
  StoreU(pack(segments.back), d, out.back.data() + out.size);
  StoreU(pack(segments.scalar_front), df, out.scalar_front.data() + out.size);
  StoreU(pack(segments.scalar_back), df, out.scalar_back.data() + out.size);
  out.size += pack.count();
}

/// Appends to SegmentStream::hit in the same way; to be called before append() of the lanes' segments.
HWY_NOINLINE inline void append_hits(MF hit, VI hits, SegmentStream& out) {
  const DI d;
  const LanePacker pack(RebindMask(d, hit));
  StoreU(pack(hits), d, out.hit.data() + out.size);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
