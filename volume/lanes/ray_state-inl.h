// SPDX-License-Identifier: BSD-3-Clause
// What a packet's rays have gathered on their way through a chunk; included once per instruction set.
//
// What      Of each lane its light since the chunk's front, where that begins, and a bound of its error.

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

/// What is noted of each ray on its way.
struct RayNotes {
  VF first;        ///< where light begins, in slabs from the chunk's first
  MF seen;         ///< whether it has
  VF error_bound;  ///< errors that may be (lane_error_bound.hpp), as seen from the chunk's front
  VF rough;        ///< squares of those that roundings make, each its own
};

/// A ray a lane: its light since the chunk's front, what is noted of it, and what its tile counts.
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
