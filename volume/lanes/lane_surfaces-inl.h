// SPDX-License-Identifier: BSD-3-Clause
// Finds the surfaces' values between which each lane's field is. Included once per instruction set (Highway's include
// guard idiom).
//
// What      Whether lanes whose field is within bounds may meet an iso-surface, and the gap between two values that
//           contains a scalar.
// How       The last gap of each lane is kept, so that usually two comparisons suffice.
// Accuracy  Gaps are narrowed by the field's noise (SurfaceView::noise) at both ends, so that no surface is missed.
// Bits      The results do not depend on the stored gaps.

#if defined(TESSERA_VOLUME_LANE_SURFACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_LANE_SURFACES_INL_H_
#undef TESSERA_VOLUME_LANE_SURFACES_INL_H_
#else
#define TESSERA_VOLUME_LANE_SURFACES_INL_H_
#endif

#include <hwy/highway.h>

#include <limits>

#include "volume/frame_view.hpp"
#include "volume/lanes/windows-inl.h"
#include "volume/precise/surface_view.hpp"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// Reads a row of SurfaceView at the given edges.
HWY_INLINE VF surface_row(const SurfaceView& view, const std::vector<float>& row, VI edge) {
  const DF d;
  if (view.count + 2 <= hn::Lanes(d)) return TableLookupLanes(LoadU(d, row.data()), IndicesFromVec(d, edge));
  return GatherIndex(d, row.data(), edge);
}

/// Returns the gap that contains a scalar (SurfaceView); for NaN, the first gap.
HWY_INLINE VI surface_gap(const SurfaceView& view, VF s) {
  const DF d;
  const DI di;
  VI gap = Zero(di);
  for (std::size_t n = 1; n <= view.count; ++n)
    gap = gap + IfThenElseZero(RebindMask(di, s >= Set(d, view.edge[n])), Set(di, 1));
  return gap;
}

/// Replaces LaneSurfaces in frames without surfaces.
struct NoSurfaces {
  explicit HWY_INLINE NoSurfaces(const FrameView&) {}
  HWY_INLINE bool none_between(VF, VF, MF) { return true; }
  template <class Window>
  HWY_INLINE bool none_in(const Window&, float) {
    return true;
  }
};

/// For each lane, the gap between two surfaces' values that contained the lane's field last, narrowed by the field's
/// noise at both ends; and one gap for all samples of a window. The stored gaps only accelerate the test that there is
/// no surface; results do not depend on them.
class LaneSurfaces {
 public:
  explicit HWY_INLINE LaneSurfaces(const FrameView& frame)
      : view_(*frame.surfaces), low_(Zero(DF())), high_(Zero(DF())) {}

  /// Whether live lanes certainly meet no surface where their field is in [low, high].
  HWY_INLINE bool none_between(VF low, VF high, MF live) {
    return HWY_LIKELY(AllFalse(DF(), outside(low, high, live))) || AllFalse(DF(), met(low, high, live));
  }
  /// Returns the live lanes that may meet a surface.
  HWY_NOINLINE MF met(VF low, VF high, MF live) {
    const DF d;
    const VI gap = surface_gap(view_, low);
    const VF noise = Set(d, view_.noise);
    low_ = surface_row(view_, view_.edge, gap) + noise;
    high_ = surface_row(view_, view_.edge, gap + Set(DI(), 1)) - noise;
    return outside(low, high, live);
  }

  /// Whether certainly no surface is met where all samples are those of the window.
  template <class Window>
  HWY_INLINE bool none_in(const Window& window, float some_sample) {
    if (window.all_in(window_low_, window_high_)) return true;
    if (!(some_sample == some_sample)) return false;
    std::size_t gap = 0;
    while (gap < view_.count && view_.edge[gap + 1] <= some_sample) ++gap;
    window_low_ = view_.edge[gap] + view_.noise, window_high_ = view_.edge[gap + 1] - view_.noise;
    return window.all_in(window_low_, window_high_);
  }

 private:
  HWY_INLINE MF outside(VF low, VF high, MF live) const { return AndNot(And(low >= low_, high < high_), live); }

  const SurfaceView& view_;
  VF low_, high_;
  float window_low_ = 0, window_high_ = 0;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
