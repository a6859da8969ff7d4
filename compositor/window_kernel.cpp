#include "compositor/window_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/window_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "compositor/integrate_lanes-inl.h"
#include "sorting/sort_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::compositor {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
std::uint64_t composite_windows(const WindowRules&, projection::SegmentWindows&, std::int32_t, WindowState&,
                                scene::TraceLaps&) {
  return 0;
}
#else
using DD = HN::ScalableTag<double>;
using VD = HN::Vec<DD>;
using HalfF = HN::Half<DF>;
constexpr std::int32_t no_key = 0x7fffffff;
static_assert(no_key == WindowState::not_yet);

/// Lane values in double: two vectors.
struct Doubles {
  VD low, high;
};
HWY_INLINE Doubles load(const double* from) {
  const DD d;
  return {HN::Load(d, from), HN::Load(d, from + HN::Lanes(d))};
}
HWY_INLINE void store(Doubles v, double* to) {
  const DD d;
  HN::Store(v.low, d, to);
  HN::Store(v.high, d, to + HN::Lanes(d));
}
HWY_INLINE Doubles promote(VF v) {
  const DD d;
  const HalfF half;
  return {HN::PromoteTo(d, HN::LowerHalf(half, v)), HN::PromoteTo(d, HN::UpperHalf(half, v))};
}
HWY_INLINE VF demote(Doubles v) {
  const HalfF half;
  return HN::Combine(DF(), HN::DemoteTo(half, v.high), HN::DemoteTo(half, v.low));
}
HWY_INLINE Doubles multiply_add(Doubles a, Doubles b, Doubles c) {
  return {HN::MulAdd(a.low, b.low, c.low), HN::MulAdd(a.high, b.high, c.high)};
}

/// Order of segments with one front.
HWY_INLINE bool level_before(const projection::LatticeSegment& a, const projection::LatticeSegment& b) {
  if (a.back != b.back) return a.back < b.back;
  if (a.scalar_front != b.scalar_front) return a.scalar_front < b.scalar_front;
  return a.scalar_back < b.scalar_back;
}

/// Puts equal keys in order, which the network does not.
HWY_NOINLINE void settle_ties(const projection::LatticeSegment* list, std::size_t stride, std::size_t count,
                              std::size_t lanes, std::int32_t* keys, std::int32_t* slots) {
  for (std::size_t i = 1; i < count; ++i) {
    const std::int32_t key = keys[i * lanes], slot = slots[i * lanes];
    const projection::LatticeSegment& segment = list[static_cast<std::size_t>(slot) * stride];
    std::size_t hole = i;
    for (; hole > 0 && keys[(hole - 1) * lanes] == key &&
           level_before(segment, list[static_cast<std::size_t>(slots[(hole - 1) * lanes]) * stride]);
         --hole)
      slots[hole * lanes] = slots[(hole - 1) * lanes];
    slots[hole * lanes] = slot;
  }
}

/// Lists longer than the networks: one lane after the other.
HWY_NOINLINE void sort_long(const projection::LatticeSegment* list, std::size_t stride, std::size_t count,
                            std::size_t lanes, std::int32_t* keys, std::int32_t* slots) {
  const auto at = [&](std::int32_t slot) -> const projection::LatticeSegment& {
    return list[static_cast<std::size_t>(slot) * stride];
  };
  std::vector<std::int32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::int32_t>(i);
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    return at(a).front != at(b).front ? at(a).front < at(b).front : level_before(at(a), at(b));
  });
  for (std::size_t i = 0; i < count; ++i) {
    keys[i * lanes] = at(order[i]).front;
    slots[i * lanes] = order[i];
  }
}

/// The pixels [pixel, pixel + lanes) of a square.
template <TableForm form>
class PixelGroup {
 public:
  PixelGroup(const Lookup<form>& table, projection::SegmentWindows& windows, std::size_t pixel, WindowState& state)
      : table_(table),
        windows_(windows),
        state_(state),
        pixel_(pixel),
        list_(windows.segments() + pixel),
        base_(reinterpret_cast<const std::int32_t*>(list_)) {}

  /// Brings keys and slots in order. Returns the number of rows: the longest list's length.
  HWY_INLINE std::size_t sort() {
    const DI d;
    const std::size_t lanes = HN::Lanes(d);
    const std::uint32_t* counts = windows_.counts() + pixel_;
    std::size_t most = 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) most = std::max<std::size_t>(most, counts[lane]);
    if (most == 0) return 0;
    const std::size_t chunks = (most + sorting::HWY_NAMESPACE::sort_chunk - 1) / sorting::HWY_NAMESPACE::sort_chunk;
    const std::size_t rows = chunks * sorting::HWY_NAMESPACE::sort_chunk;
    if (state_.keys.size() < rows * lanes) state_.keys.resize(rows * lanes), state_.slots.resize(rows * lanes);
    std::int32_t *keys = state_.keys.data(), *slots = state_.slots.data();
    const VI count = HN::LoadU(d, reinterpret_cast<const std::int32_t*>(counts));
    const VI first = HN::ShiftLeft<2>(HN::Iota(d, 0));
    for (std::size_t row = 0; row < rows; ++row) {
      const auto here = HN::Lt(HN::Set(d, static_cast<std::int32_t>(row)), count);
      VI key = HN::Set(d, no_key);
      if (row < most) key = HN::IfThenElse(here, HN::GatherIndex(d, base_ + 4 * row * windows_.stride(), first), key);
      HN::StoreU(key, d, keys + row * lanes);
      HN::StoreU(HN::IfThenElseZero(here, HN::Set(d, static_cast<std::int32_t>(row))), d, slots + row * lanes);
    }
    if (chunks <= 4) {
      sorting::HWY_NAMESPACE::sort_lanes(keys, slots, static_cast<int>(chunks));
      auto ties = HN::Lt(count, HN::Zero(d));
      VI key = HN::LoadU(d, keys);
      for (std::size_t row = 1; row < most; ++row) {
        const VI next = HN::LoadU(d, keys + row * lanes);
        ties = HN::Or(ties, HN::And(HN::Eq(key, next), HN::Ne(next, HN::Set(d, no_key))));
        key = next;
      }
      if (!HN::AllFalse(d, ties)) {
        std::uint8_t bits[8] = {0};
        HN::StoreMaskBits(d, ties, bits);
        for (std::uint64_t left = bits[0] | static_cast<std::uint64_t>(bits[1]) << 8; left != 0; left &= left - 1) {
          const auto lane = static_cast<std::size_t>(__builtin_ctzll(left));
          settle_ties(list_ + lane, windows_.stride(), counts[lane], lanes, keys + lane, slots + lane);
        }
      }
    } else {
      for (std::size_t lane = 0; lane < lanes; ++lane)
        sort_long(list_ + lane, windows_.stride(), counts[lane], lanes, keys + lane, slots + lane);
    }
    return most;
  }

  /// Composites what lies before `final_step`; returns how many segments are done with.
  HWY_INLINE std::uint64_t composite(std::size_t rows, std::int32_t final_step, const WindowRules& rules) {
    const DI d;
    const DF df;
    const std::size_t lanes = HN::Lanes(d);
    const std::size_t p = pixel_;
    load_light();
    Doubles ray = load(rules.runs ? &state_.ray_transmittance[p] : &state_.transmittance[p]);
    const VF length_per_step = HN::Load(df, &state_.length_per_step[p]);
    VI open = HN::Load(d, &state_.open[p]);
    const VF least_transmittance = HN::Set(df, static_cast<float>(rules.least_transmittance));
    const VI first = HN::ShiftLeft<2>(HN::Iota(d, 0)), end = HN::Set(d, final_step);
    const VI stride = HN::Set(d, static_cast<std::int32_t>(4 * windows_.stride()));
    const float* scalars = reinterpret_cast<const float*>(base_);
    VI done = HN::Zero(d);
    for (std::size_t row = 0; row < rows; ++row) {
      const VI front = HN::LoadU(d, state_.keys.data() + row * lanes);
      const auto is_final = HN::Lt(front, end);
      const auto takes = HN::And(is_final, HN::Lt(open, HN::Zero(d)));
      done = HN::Sub(done, HN::VecFromMask(d, is_final));
      if (HN::AllFalse(d, takes)) {
        if (HN::AllFalse(d, is_final)) break;
        continue;
      }
      const VI at = HN::Add(first, HN::Mul(stride, HN::LoadU(d, state_.slots.data() + row * lanes)));
      const VI back = HN::GatherIndex(d, base_ + 1, at);
      const VF scalar_front = HN::GatherIndex(df, scalars + 2, at), scalar_back = HN::GatherIndex(df, scalars + 3, at);
      const VF length = HN::Mul(HN::ConvertTo(df, HN::Sub(back, front)), length_per_step);
      const Light light = integrate_lanes(table_, length, scalar_front, scalar_back, HN::RebindMask(df, takes));

      auto shows = HN::Gt(light.optical_depth, HN::Zero(df));
      if (rules.runs) {
        go_on_in_run(takes, HN::RebindMask(d, shows), front, back);
        // A run begins where it shows, if only by light (independent emission).
        const VF colors = HN::Add(HN::Abs(light.red), HN::Add(HN::Abs(light.green), HN::Abs(light.blue)));
        shows = HN::Or(shows, HN::Gt(colors, HN::Zero(df)));
        const auto again =
            HN::And(HN::RebindMask(d, shows), HN::Ne(HN::Load(d, &state_.first_back[p]), HN::Set(d, no_key)));
        HN::Store(HN::Or(HN::Load(d, &state_.several[p]), HN::VecFromMask(d, again)), d, &state_.several[p]);
      }
      const VI seen = HN::Load(d, &state_.first_back[p]);
      const auto appears = HN::And(HN::RebindMask(d, shows), HN::Eq(seen, HN::Set(d, no_key)));
      if (!HN::AllFalse(d, appears)) {
        const auto keep = [&](auto value, auto tag, auto* to) HWY_ATTR {
          HN::Store(HN::IfThenElse(HN::RebindMask(tag, appears), value, HN::Load(tag, to)), tag, to);
        };
        keep(front, d, &state_.first_front[p]);
        keep(back, d, &state_.first_back[p]);
        keep(scalar_front, df, &state_.first_scalar_front[p]);
        keep(scalar_back, df, &state_.first_scalar_back[p]);
      }
      red_ = multiply_add(transmittance_, promote(light.red), red_);
      green_ = multiply_add(transmittance_, promote(light.green), green_);
      blue_ = multiply_add(transmittance_, promote(light.blue), blue_);
      const Doubles depth = promote(light.optical_depth), alpha = promote(light.alpha);
      optical_depth_ = {HN::Add(optical_depth_.low, depth.low), HN::Add(optical_depth_.high, depth.high)};
      transmittance_ = dimmed(transmittance_, alpha);
      ray = rules.runs ? dimmed(ray, alpha) : transmittance_;
      // After each segment, not each window: where a ray ends must not depend on how its segments were cut.
      open = HN::And(open, HN::VecFromMask(d, HN::RebindMask(d, HN::Ge(demote(ray), least_transmittance))));
    }
    store_light();
    if (rules.runs) store(ray, &state_.ray_transmittance[p]);
    HN::Store(open, d, &state_.open[p]);
    return keep_rest(done);
  }

 private:
  HWY_INLINE static Doubles dimmed(Doubles transmittance, Doubles alpha) {
    return {HN::NegMulAdd(transmittance.low, alpha.low, transmittance.low),
            HN::NegMulAdd(transmittance.high, alpha.high, transmittance.high)};
  }
  HWY_INLINE void load_light() {
    const std::size_t p = pixel_;
    red_ = load(&state_.red[p]), green_ = load(&state_.green[p]), blue_ = load(&state_.blue[p]);
    optical_depth_ = load(&state_.optical_depth[p]), transmittance_ = load(&state_.transmittance[p]);
  }
  HWY_INLINE void store_light() {
    const std::size_t p = pixel_;
    store(red_, &state_.red[p]), store(green_, &state_.green[p]), store(blue_, &state_.blue[p]);
    store(optical_depth_, &state_.optical_depth[p]), store(transmittance_, &state_.transmittance[p]);
  }

  /// Ends the runs of lanes whose next segment does not touch; then all that take one are in a run up to its back.
  /// Light without extinction (independent emission) does not share a run with what absorbs behind it either: a run's
  /// front is where absorption begins.
  HWY_INLINE void go_on_in_run(HN::Mask<DI> takes, HN::Mask<DI> absorbs, VI front, VI back) {
    const DI d;
    const std::size_t p = pixel_;
    const VI run_back = HN::Load(d, &state_.back[p]);
    const auto in_run = HN::And(takes, HN::Ne(run_back, HN::Set(d, no_key)));
    const VI gap = HN::Abs(HN::Sub(front, run_back));
    auto ends = HN::And(in_run, HN::Gt(gap, HN::Set(d, touching_steps)));
    const DF df;
    const auto clear = HN::RebindMask(d, HN::Le(demote(optical_depth_), HN::Zero(df)));
    const auto lit = HN::Ne(HN::Load(d, &state_.first_back[p]), HN::Set(d, no_key));
    ends = HN::Or(ends, HN::And(HN::And(in_run, absorbs), HN::And(lit, clear)));
    if (HWY_UNLIKELY(!HN::AllFalse(d, ends))) {
      store_light();
      std::uint8_t bits[8] = {0};
      HN::StoreMaskBits(d, ends, bits);
      for (std::uint64_t left = bits[0] | static_cast<std::uint64_t>(bits[1]) << 8; left != 0; left &= left - 1)
        state_.end_run(p + static_cast<std::size_t>(__builtin_ctzll(left)));
      load_light();
    }
    // Irregular cells' depths are a few steps off: a run does not go back.
    const VI now = HN::Load(d, &state_.back[p]);
    const VI on = HN::IfThenElse(HN::Eq(now, HN::Set(d, no_key)), back, HN::Max(now, back));
    HN::Store(HN::IfThenElse(takes, on, now), d, &state_.back[p]);
  }

  /// Leaves in the windows what was not final. Returns how many segments are gone.
  HWY_INLINE std::uint64_t keep_rest(VI done) {
    const DI d;
    const std::size_t lanes = HN::Lanes(d);
    std::uint32_t* counts = windows_.counts() + pixel_;
    alignas(64) std::int32_t finished[HN::MaxLanes(DI())];
    HN::Store(done, d, finished);
    std::uint64_t gone = 0;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t count = counts[lane];
      std::size_t from = state_.open[pixel_ + lane] != 0 ? static_cast<std::size_t>(finished[lane]) : count;
      gone += from;
      counts[lane] = static_cast<std::uint32_t>(count - from);
      if (from == count) continue;
      if (state_.rest.size() < count) state_.rest.resize(count);
      std::size_t kept = 0;
      const std::size_t stride = windows_.stride();
      for (; from < count; ++from)
        state_.rest[kept++] = list_[lane + static_cast<std::size_t>(state_.slots[from * lanes + lane]) * stride];
      for (std::size_t k = 0; k < kept; ++k) list_[lane + k * stride] = state_.rest[k];
    }
    return gone;
  }

  const Lookup<form>& table_;
  projection::SegmentWindows& windows_;
  WindowState& state_;
  std::size_t pixel_;
  projection::LatticeSegment* list_;
  const std::int32_t* base_;
  Doubles red_, green_, blue_, optical_depth_, transmittance_;
};

template <TableForm form>
std::uint64_t composite_form(const WindowRules& rules, projection::SegmentWindows& windows, std::int32_t final_step,
                             WindowState& state, scene::TraceLaps& laps) {
  const Lookup<form> lookup(*rules.table);
  std::uint64_t done = 0;
  for (std::size_t pixel = 0; pixel < windows.pixels(); pixel += HN::Lanes(DI())) {
    PixelGroup<form> group(lookup, windows, pixel, state);
    const std::size_t rows = group.sort();
    laps.lap("sort");
    if (rows > 0) done += group.composite(rows, final_step, rules);
    laps.lap("integrate");
  }
  return done;
}

std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int32_t final_step,
                                WindowState& state, scene::TraceLaps& laps) {
  switch (form_of(*rules.table)) {
    case TableForm::one_vector:
      return composite_form<TableForm::one_vector>(rules, windows, final_step, state, laps);
    case TableForm::two_vectors:
      return composite_form<TableForm::two_vectors>(rules, windows, final_step, state, laps);
    case TableForm::many:
      break;
  }
  return composite_form<TableForm::many>(rules, windows, final_step, state, laps);
}
#endif  // HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::compositor {
HWY_EXPORT(composite_windows);

std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int64_t final_step,
                                WindowState& state, scene::TraceLaps& laps) {
  const auto end = static_cast<std::int32_t>(std::clamp<std::int64_t>(final_step, -0x7fffffff, 0x7fffffff));
  return HWY_DYNAMIC_DISPATCH(composite_windows)(rules, windows, end, state, laps);
}

}  // namespace tessera::compositor
#endif  // HWY_ONCE
