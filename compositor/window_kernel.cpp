// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/window_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/window_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "compositor/deep/window_samples-inl.h"
#include "compositor/window_light-inl.h"
#include "sorting/sort_windows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::compositor {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
std::uint64_t composite_windows(const WindowRules&, projection::SegmentWindows&, std::int32_t, std::int32_t,
                                WindowState&, scene::StageTimer&) {
  return 0;
}
#else
using sorting::HWY_NAMESPACE::has_row;
using sorting::HWY_NAMESPACE::PixelList;
using sorting::HWY_NAMESPACE::segment_at;

/// Each vector contains whole segments, each in four consecutive elements. Transposes four such vectors to one vector
/// per field, in a quarter of the time of gathers. Segment i of vector k goes to lane 4 i + k.
HWY_INLINE SegmentLanes transposed(VI v0, VI v1, VI v2, VI v3) {
  const DI d;
  const hn::RepartitionToWide<DI> wide;
  const auto pairs = [&](VI v) HWY_ATTR { return BitCast(wide, v); };
  const auto low01 = pairs(InterleaveLower(d, v0, v1)), high01 = pairs(InterleaveUpper(d, v0, v1));
  const auto low23 = pairs(InterleaveLower(d, v2, v3)), high23 = pairs(InterleaveUpper(d, v2, v3));
  const DF df;
  return {BitCast(d, InterleaveLower(wide, low01, low23)), BitCast(d, InterleaveUpper(wide, low01, low23)),
          BitCast(df, InterleaveLower(wide, high01, high23)), BitCast(df, InterleaveUpper(wide, high01, high23))};
}

/// Loads `lanes` / 4 whole segments into one vector: those that load_segments() needs for lanes first, first + 4, first
/// + 8...
template <std::size_t lanes>
HWY_INLINE auto load_every_fourth(const projection::LatticeSegment* list, const std::int32_t* slots, int first) {
  if constexpr (lanes == 4) {
    return Load(hn::FixedTag<std::int32_t, 4>(),
                reinterpret_cast<const std::int32_t*>(&segment_at(list + first, slots[first])));
  } else {
    const auto low = load_every_fourth<lanes / 2>(list, slots, first);
    const auto high = load_every_fourth<lanes / 2>(list, slots, first + static_cast<int>(lanes) / 2);
    return Combine(hn::FixedTag<std::int32_t, lanes>(), high, low);
  }
}

/// Loads one segment per lane. The slot of a lane's segment is counted from list[lane].
HWY_INLINE SegmentLanes load_segments(const projection::LatticeSegment* list, const std::int32_t* slots) {
  return transposed(load_every_fourth<most_lanes>(list, slots, 0), load_every_fourth<most_lanes>(list, slots, 1),
                    load_every_fourth<most_lanes>(list, slots, 2), load_every_fourth<most_lanes>(list, slots, 3));
}

/// Composites the pixels [pixel, pixel + lanes) of a square.
template <TableForm form>
class PixelGroup {
 public:
  PixelGroup(const Lookup<form>& table, projection::SegmentWindows& windows, std::size_t pixel, WindowState& state,
             LightRows& light)
      : table_(table),
        windows_(windows),
        state_(state),
        light_(light),
        pixel_(pixel),
        list_(windows.segments() + pixel),
        lights_(windows.lights() != nullptr ? windows.lights() + pixel : nullptr) {}

  /// Sorts the lists' slots. Returns the number of rows, which is the length of the longest list.
  HWY_INLINE std::size_t sort() {
    return sorting::HWY_NAMESPACE::sort_windows({list_, lights_}, windows_.stride(), windows_.counts() + pixel_,
                                                state_.order);
  }

  /// Loads the segments of the rows [from, to) that are before `final_step` and in open pixels; for runs, it stores
  /// where they end. Returns the end of the loaded rows, which is after the last row with a final segment.
  template <bool runs, bool with_surfaces>
  HWY_INLINE std::size_t load(std::size_t from, std::size_t to, std::int32_t final_step,
                              const scene::SurfaceSet* surfaces) {
    const DI d;
    const DF df;
    const std::size_t lanes = hn::Lanes(d);
    const VF length_per_step = Load(df, &state_.length_per_step[pixel_]);
    const auto open = Load(d, &state_.open[pixel_]) < Zero(d);
    const VI end = Set(d, final_step), none = Set(d, no_key);
    VI run_back = none;
    VI widest = Zero(d);
    const VI count = this->count();
    if constexpr (runs) run_back = Load(d, &state_.back[pixel_]);
    for (std::size_t row = from; row < to; ++row) {
      SegmentLanes s = load_segments(list_, state_.order.slots.data() + row * lanes);
      const VI front = s.front;
      const MI is_final = And(front < end, has_row(row, count));
      if (AllFalse(d, is_final)) {
        to = row;
        break;
      }
      done_ = count_if(RebindMask(df, is_final), done_);
      if constexpr (with_surfaces)
        s.scalar_front =
            light_.set_aside_surfaces(surfaces->on_lattice_by_number(), is_final, open, s.scalar_front, row - from);
      const MI takes = And(is_final, open);
      const VF length = IfThenElseZero(RebindMask(df, takes), ConvertTo(df, s.back - front) * length_per_step);
      s.front = IfThenElse(takes, front, none);
      light_.put_segment(s, length, table_.locate(s.scalar_front, s.scalar_back >= s.scalar_front),
                         (row - from) * lanes);
      if constexpr (runs) {
        // A lane that is not in a run begins one in the first of these rows, or takes no segment from any of them,
        // because lists have no gaps.
        if (row == from) run_back = IfThenElse(And(takes, run_back == none), front, run_back);
        widest = Max(widest, Abs(IfThenElseZero(takes, front - run_back)));
        // The depths of irregular cells differ by a few steps, so the end of a run must never decrease.
        run_back = IfThenElse(takes, Max(run_back, s.back), run_back);
      }
    }
    if constexpr (runs) {
      Store(run_back, d, light_.run_back);
      light_.touching = AllFalse(d, widest > Set(d, touching_steps));
    }
    return to;
  }

  template <bool runs>
  HWY_INLINE std::size_t load(std::size_t from, std::size_t to, std::int32_t final_step, const WindowRules& rules) {
    return rules.surfaces != nullptr ? load<runs, true>(from, to, final_step, rules.surfaces)
                                     : load<runs, false>(from, to, final_step, nullptr);
  }

  /// Loads the lights of the segments in the rows [from, to).
  HWY_NOINLINE void load_lights(std::size_t from, std::size_t to) {
    const DI d;
    const DF df;
    const std::size_t lanes = hn::Lanes(d);
    for (std::size_t row = from; row < to; ++row) {
      // A light is half as long as a segment.
      const VI slots = LoadU(d, state_.order.slots.data() + row * lanes);
      const VI place = ShiftRight<1>(slots) + Iota(d, 0) * Set(d, static_cast<std::int32_t>(sizeof *lights_));
      Store(GatherOffset(df, &lights_->own, place), df, light_.own + (row - from) * lanes);
      Store(GatherOffset(df, &lights_->white, place), df, light_.white + (row - from) * lanes);
    }
  }

  /// Composites the segments before `final_step`; returns the number of segments that are finished.
  HWY_INLINE std::uint64_t composite(std::size_t rows, std::int32_t final_step, const WindowRules& rules) {
    done_ = Zero(DI());
    for (std::size_t from = 0, to; from < rows; from = to) {
      const std::size_t most = std::min(rows, from + LightRows::most);
      // There are three passes, whose dependency chains are short enough for a processor to work on several rows at
      // once.
      to = rules.runs ? load<true>(from, most, final_step, rules) : load<false>(from, most, final_step, rules);
      if (HWY_UNLIKELY(rules.integrator != nullptr))
        light_.integrate_in_double(*rules.integrator, *rules.lattice, to - from, state_.batch);
      else
        light_.integrate(table_, to - from);
      if (HWY_UNLIKELY(lights_ != nullptr)) {
        load_lights(from, to);
        light_.light_matter(to - from);
      }
      if (HWY_UNLIKELY(rules.surfaces != nullptr))
        light_.put_surfaces(*rules.surfaces, table_, rules.table->color_unit, rules.runs || some_unseen());
      if (HWY_UNLIKELY(rules.samples != nullptr))
        GroupSamples<form>(table_, state_, light_, pixel_, *rules.samples).add(to - from, rules.least_transmittance);
      if (!GroupLight(state_, light_, pixel_, table_.independent).add(to - from, rules) || to < most) break;
    }
    return keep_rest(rows);
  }

 private:
  /// Whether the pixel of some lane has no visible segment yet.
  HWY_INLINE bool some_unseen() const {
    const DI d;
    return !AllFalse(d, Load(d, &state_.first_back[pixel_]) == Set(d, no_key));
  }

  HWY_INLINE VI count() const { return LoadU(DI(), reinterpret_cast<const std::int32_t*>(windows_.counts() + pixel_)); }

  /// Keeps in the windows, in order, the sorted segments that were not final. Returns the number of removed segments.
  HWY_INLINE std::uint64_t keep_rest(std::size_t rows) {
    const DI d;
    // The memory of lanes beyond the last pixel belongs to other lists, so nothing is written there.
    const std::size_t lanes = hn::Lanes(d), own = std::min(lanes, windows_.pixels() - pixel_);
    std::uint32_t* counts = windows_.counts() + pixel_;
    const VI count = this->count();
    const auto open = Load(d, &state_.open[pixel_]) < Zero(d);
    const VI left = IfThenElseZero(open, count - done_);
    StoreU(left, d, reinterpret_cast<std::int32_t*>(counts));
    const auto most = static_cast<std::size_t>(GetLane(MaxOfLanes(d, left)));
    state_.rest_rows[pixel_ / lanes] = static_cast<std::int32_t>(most);
    const auto gone = static_cast<std::uint64_t>(GetLane(SumOfLanes(d, count - left)));
    if (most == 0) return gone;
    // All lanes copy the same number of elements, so that no branch depends on the lane. Surplus elements are stored
    // after the end of the lane's list.
    alignas(64) std::int32_t first[most_lanes];
    Store(done_, d, first);
    if (state_.rest.size() < most * lanes) state_.rest.resize(most * lanes);
    if (lights_ != nullptr && state_.rest_lights.size() < most * lanes) state_.rest_lights.resize(most * lanes);
    for (std::size_t k = 0; k < most; ++k)
      for (std::size_t lane = 0; lane < own; ++lane) {
        const std::size_t row = std::min(static_cast<std::size_t>(first[lane]) + k, rows - 1);
        const std::int32_t slot = state_.order.slots[row * lanes + lane];
        state_.rest[k * lanes + lane] = segment_at(list_ + lane, slot);
        if (lights_ != nullptr)
          state_.rest_lights[k * lanes + lane] = PixelList{list_, lights_}.of_lane(lane).light_at(slot);
      }
    for (std::size_t k = 0; k < most; ++k) {
      std::copy_n(&state_.rest[k * lanes], own, list_ + k * windows_.stride());
      if (lights_ != nullptr) std::copy_n(&state_.rest_lights[k * lanes], own, lights_ + k * windows_.stride());
    }
    return gone;
  }

  const Lookup<form>& table_;
  projection::SegmentWindows& windows_;
  WindowState& state_;
  LightRows& light_;
  std::size_t pixel_;
  projection::LatticeSegment* list_;
  projection::SegmentLight* lights_;  ///< null: segments have no lights
  VI done_ = Zero(DI());              ///< for each lane, the number of segments that were final
};

template <TableForm form>
std::uint64_t composite_form(const WindowRules& rules, projection::SegmentWindows& windows, std::int32_t final_step,
                             std::int32_t at_least, WindowState& state, scene::StageTimer& timer) {
  const Lookup<form> lookup(*rules.table);
  std::uint64_t done = 0;
  LightRows light;
  const DI d;
  const auto full = static_cast<std::int32_t>(windows.capacity());
  for (std::size_t pixel = 0; pixel < windows.pixels(); pixel += hn::Lanes(d)) {
    const VI count = LoadU(d, reinterpret_cast<const std::int32_t*>(windows.counts() + pixel));
    const std::int32_t worthwhile =
        at_least == 1 ? 1 : std::max(at_least, std::min(2 * state.rest_rows[pixel / hn::Lanes(d)], full));
    if (AllFalse(d, count > Set(d, worthwhile - 1))) continue;
    PixelGroup<form> group(lookup, windows, pixel, state, light);
    const std::size_t rows = group.sort();
    timer.record("sort");
    done += group.composite(rows, final_step, rules);
    timer.record("integrate");
  }
  return done;
}

std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int32_t final_step,
                                std::int32_t at_least, WindowState& state, scene::StageTimer& timer) {
  switch (form_of(*rules.table)) {
    case TableForm::one_vector:
      return composite_form<TableForm::one_vector>(rules, windows, final_step, at_least, state, timer);
    case TableForm::two_vectors:
      return composite_form<TableForm::two_vectors>(rules, windows, final_step, at_least, state, timer);
    case TableForm::many:
      break;
  }
  return composite_form<TableForm::many>(rules, windows, final_step, at_least, state, timer);
}
#endif  // HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::compositor {
HWY_EXPORT(composite_windows);

std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int64_t final_step,
                                std::size_t at_least, WindowState& state, scene::StageTimer& timer) {
  state.lit = windows.lights() != nullptr;
  state.is_in_double = rules.integrator != nullptr;
  const auto end = static_cast<std::int32_t>(std::clamp<std::int64_t>(final_step, -0x7fffffff, 0x7fffffff));
  const auto several = static_cast<std::int32_t>(std::clamp<std::size_t>(at_least, 1, 0x7fffffff));
  return HWY_DYNAMIC_DISPATCH(composite_windows)(rules, windows, end, several, state, timer);
}

}  // namespace tessera::compositor
#endif  // HWY_ONCE
