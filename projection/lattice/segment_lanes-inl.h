// SPDX-License-Identifier: BSD-3-Clause
// Appends segments of the lattice from lanes to a SegmentStream. Included once per instruction set (Highway's include
// guard idiom).
//
// What      SegmentLanes is a LatticeSegment in structure-of-arrays form, one segment per lane. append() adds the lanes
//           of a mask to the stream, in the order of the lanes.
// How       The lanes of the mask are packed in registers by one permutation (LanePacker) and stored as whole vectors:
//
//             mask      1  0  1  1  0  0  1  0
//             lanes     a  b  c  d  e  f  g  h
//             stored    a  c  d  g  x  x  x  x    x: any lanes, overwritten by the next call
//                       ^           ^
//                       size before size after
//
// Ends      The arrays need room for a whole vector behind `size`, which SegmentStream::padding provides. Not defined
//           for HWY_SCALAR.

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

/// Appends the segments of those lanes that are set in `hit`. They are packed in registers and stored as whole vectors.
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

/// Appends to SegmentStream::own and white in the same way; must be called before append() is called for these
/// segments.
HWY_INLINE void append_light(MF hit, VF own, VF white, SegmentStream& out) {
  const LanePacker pack(RebindMask(DI(), hit));
  StoreU(pack(own), DF(), out.own.data() + out.size);
  StoreU(pack(white), DF(), out.white.data() + out.size);
}

/// Appends to SegmentStream::hit what append() appends to the other arrays; must be called before append().
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
