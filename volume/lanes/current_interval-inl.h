// SPDX-License-Identifier: BSD-3-Clause
// The interval of the transfer function that a packet is currently in. Included once per instruction set (Highway's
// include guard idiom).
//
// What      Provides the table's row of that interval, for all lanes, and tests whether scalars are in the interval.
// How       Consecutive slabs are usually in the same interval, so a comparison with the interval's ends replaces a
//           search in each lane.
// Accuracy  Where the interval ends at a step of the function, the end is moved inwards by the field's noise
//           (lane_error_bound.hpp). For samples it is not moved if lanes represent the samples and the step exactly.

#if defined(TESSERA_VOLUME_CURRENT_INTERVAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_CURRENT_INTERVAL_INL_H_
#undef TESSERA_VOLUME_CURRENT_INTERVAL_INL_H_
#else
#define TESSERA_VOLUME_CURRENT_INTERVAL_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/frame_view.hpp"
#include "volume/lanes/ray_piece-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// The interval of the transfer function that a packet is currently in, prepared for lookups.
class CurrentInterval {
 public:
  HWY_INLINE CurrentInterval(const LaneTable& table, const FrameView& frame) : table_(table), frame_(frame) {
    uniform_.independent = table.emission == scene::Emission::independent;
    set(0);
  }
  /// Whether all samples of the window are certainly in one interval, which then becomes the current one.
  template <class Window>
  HWY_INLINE bool holds(const Window& window, float some_sample) {
    if (window.all_in(held_low_, held_high_)) return true;
    const std::size_t n = interval_of(some_sample);
    if (n == interval_) return false;
    set(n);
    return window.all_in(held_low_, held_high_);
  }
  /// Returns the interval of a lane scalar.
  [[nodiscard]] HWY_INLINE std::size_t interval_of(float s) const {
    const float* const knots = table_.column(LaneTable::edge) + 1;
    return static_cast<std::size_t>(std::upper_bound(knots, knots + table_.knot_count, s) - knots);
  }
  /// Whether [low, high] is in the current interval in all live lanes, with a margin where the interval ends at a step.
  [[nodiscard]] HWY_INLINE bool around(VF low, VF high, MF live) const {
    const DF d;
    const MF below = high < Set(d, guarded_high_);
    return AllFalse(d, AndNot(And(low >= Set(d, guarded_low_), below), live));
  }
  /// Whether a sample is certainly in the current interval.
  [[nodiscard]] HWY_INLINE bool holds(float s) const { return held_low_ <= s && s < held_high_; }
  /// Makes a sample's interval the current one; the first interval for a blank.
  HWY_INLINE void begin_at(float sample) { move_to(sample == sample ? interval_of(sample) : 0); }
  /// Makes interval n the current one.
  HWY_INLINE void move_to(std::size_t n) {
    if (n != interval_) set(n);
  }
  [[nodiscard]] HWY_INLINE bool clear() const { return clear_; }
  [[nodiscard]] HWY_INLINE const UniformLookup& uniform() const { return uniform_; }

 private:
  HWY_NOINLINE void set(std::size_t n) {
    interval_ = n;
    low_ = table_.column(LaneTable::edge)[n];
    high_ = table_.column(LaneTable::edge)[n + 1];
    guarded_low_ = held_low_ = low_, guarded_high_ = held_high_ = high_;
    uniform_.ramp = uniform_.ramp_steady = uniform_.ramp_color = 0;
    if (frame_.error_bound != nullptr) {
      const LaneErrorBound& bound = *frame_.error_bound;
      if (!bound.step.empty() && bound.step[n] > 0) guarded_low_ += bound.noise;
      if (!bound.step.empty() && bound.step[n + 1] > 0) guarded_high_ -= bound.noise;
      // Samples that lanes represent exactly are on the correct side of a step. So is the field if all samples are on
      // that side.
      if (bound.sharp[n] == 0) held_low_ = guarded_low_;
      if (bound.sharp[n + 1] == 0) held_high_ = guarded_high_;
      if (!bound.ramp.empty() && bound.ramp[n] > 0)
        uniform_.ramp = bound.ramp[n], uniform_.ramp_steady = bound.steady * bound.ramp[n],
        uniform_.ramp_color = bound.ramp_color[n];
    }
    clear_ = true;
    for (int c = 0; c < LaneTable::column_count; ++c) {
      uniform_.row[c] = table_.column(c)[n];
      const bool color = c >= LaneTable::red;
      if (c >= LaneTable::half_extinction && (!color || uniform_.independent) && uniform_.row[c] != 0) clear_ = false;
    }
    const float slope = 2 * std::abs(uniform_.row[LaneTable::half_extinction_slope]);
    const float color_slope =
        std::max({std::abs(uniform_.row[LaneTable::red_slope]), std::abs(uniform_.row[LaneTable::green_slope]),
                  std::abs(uniform_.row[LaneTable::blue_slope])});
    uniform_.product_bound = uniform_.independent ? 0 : 0.1f * slope * color_slope / frame_.piece_tolerance;
    uniform_.shadow_bound = 0.03f * slope * slope * frame_.largest_color / frame_.piece_tolerance;
    uniform_.extinction = 2 * uniform_.row[LaneTable::half_extinction];
    if (slope > 0) uniform_.extinction += slope * (high_ - low_);
    uniform_.dimming_bound =
        uniform_.extinction * (uniform_.independent ? 1 : uniform_.extinction) * color_slope / frame_.piece_tolerance;
  }

  const LaneTable& table_;
  const FrameView& frame_;
  std::size_t interval_ = 0;
  float low_, high_;
  float guarded_low_, guarded_high_;  ///< moved inwards by the field's noise where the interval ends at a step
  float held_low_, held_high_;        ///< the same, except at steps where exact samples need no margin
  bool clear_ = false;
  UniformLookup uniform_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
