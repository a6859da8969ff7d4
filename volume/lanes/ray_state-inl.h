// SPDX-License-Identifier: BSD-3-Clause
// The accumulated state of a packet's rays in a chunk. Included once per instruction set (Highway's include guard
// idiom).
//
// What      For each lane: its light since the chunk's front, the position where light begins, and a bound of the
//           error.

#if defined(TESSERA_VOLUME_RAY_STATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_RAY_STATE_INL_H_
#undef TESSERA_VOLUME_RAY_STATE_INL_H_
#else
#define TESSERA_VOLUME_RAY_STATE_INL_H_
#endif

#include <hwy/highway.h>

#include "volume/frame_view.hpp"
#include "volume/lanes/ray_cubic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

using CL::lanes::Progress;

/// Records of each ray that are updated along its path.
struct RayNotes {
  VF first;        ///< where light begins, in slabs from the chunk's first slab
  MF seen;         ///< whether light has begun
  VF error_bound;  ///< possible errors (lane_error_bound.hpp), as seen from the chunk's front
  VF rough;        ///< sum of squares of independent rounding errors
};

/// One ray per lane: its light since the chunk's front, its records, and the counts of its tile.
struct RayState {
  Progress light;
  RayNotes notes;
  TileCounts& counts;
};

HWY_INLINE void note_first_light(const Progress& progress, VF place, RayNotes& notes) {
  const DF d;
  const MF now = AndNot(notes.seen, progress.alpha > Zero(d));
  notes.first = IfThenElse(now, place, notes.first);
  notes.seen = Or(notes.seen, now);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
