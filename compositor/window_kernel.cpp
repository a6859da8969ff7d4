#include "compositor/window_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "compositor/window_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "compositor/integrate_lanes-inl.h"
#include "projection/pack_lanes-inl.h"
#include "sorting/sort_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::compositor {
namespace HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR
std::uint64_t composite_windows(const WindowRules&, projection::SegmentWindows&, std::int32_t, std::int32_t,
                                WindowState&, scene::TraceLaps&) {
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

/// The segment `slot` bytes behind `list`. Slots in bytes spare the address a shift.
HWY_INLINE const projection::LatticeSegment& segment_at(const projection::LatticeSegment* list, std::int32_t slot) {
  return *reinterpret_cast<const projection::LatticeSegment*>(reinterpret_cast<const char*>(list) + slot);
}

/// Puts equal keys in order, which the network does not.
HWY_NOINLINE void settle_ties(const projection::LatticeSegment* list, std::size_t count, std::size_t lanes,
                              std::int32_t* keys, std::int32_t* slots) {
  for (std::size_t i = 1; i < count; ++i) {
    const std::int32_t key = keys[i * lanes], slot = slots[i * lanes];
    std::size_t hole = i;
    for (; hole > 0 && keys[(hole - 1) * lanes] == key &&
           level_before(segment_at(list, slot), segment_at(list, slots[(hole - 1) * lanes]));
         --hole)
      slots[hole * lanes] = slots[(hole - 1) * lanes];
    slots[hole * lanes] = slot;
  }
}

/// Lists longer than the networks: one lane after the other.
HWY_NOINLINE void sort_long(const projection::LatticeSegment* list, std::size_t stride, std::size_t count,
                            std::size_t lanes, std::int32_t* keys, std::int32_t* slots) {
  std::vector<std::int32_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = static_cast<std::int32_t>(i * stride * sizeof *list);
  std::sort(order.begin(), order.end(), [&](std::int32_t i, std::int32_t j) {
    const projection::LatticeSegment &a = segment_at(list, i), &b = segment_at(list, j);
    return a.front != b.front ? a.front < b.front : level_before(a, b);
  });
  for (std::size_t i = 0; i < count; ++i) {
    keys[i * lanes] = segment_at(list, order[i]).front;
    slots[i * lanes] = order[i];
  }
}

/// One field of four segments a lane each, in lanes 4 j + i of vector i: transposed in registers, which takes a quarter
/// of the time of gathers.
struct Fields {
  VI front, back;
  VF scalar_front, scalar_back;
};
constexpr std::size_t most_lanes = HN::MaxLanes(DI());

HWY_INLINE Fields transposed(VI v0, VI v1, VI v2, VI v3) {
  const DI d;
  const HN::RepartitionToWide<DI> wide;
  const auto pairs = [&](VI v) HWY_ATTR { return HN::BitCast(wide, v); };
  const auto low01 = pairs(HN::InterleaveLower(d, v0, v1)), high01 = pairs(HN::InterleaveUpper(d, v0, v1));
  const auto low23 = pairs(HN::InterleaveLower(d, v2, v3)), high23 = pairs(HN::InterleaveUpper(d, v2, v3));
  const DF df;
  return {HN::BitCast(d, HN::InterleaveLower(wide, low01, low23)),
          HN::BitCast(d, HN::InterleaveUpper(wide, low01, low23)),
          HN::BitCast(df, HN::InterleaveLower(wide, high01, high23)),
          HN::BitCast(df, HN::InterleaveUpper(wide, high01, high23))};
}

/// Those of load_fields(), `lanes` / 4 of them: lanes first, first + 4, first + 8...
template <std::size_t lanes>
HWY_INLINE auto load_every_fourth(const projection::LatticeSegment* list, const std::int32_t* slots, int first) {
  if constexpr (lanes == 4) {
    return HN::Load(HN::FixedTag<std::int32_t, 4>(),
                    reinterpret_cast<const std::int32_t*>(&segment_at(list + first, slots[first])));
  } else {
    const auto low = load_every_fourth<lanes / 2>(list, slots, first);
    const auto high = load_every_fourth<lanes / 2>(list, slots, first + static_cast<int>(lanes) / 2);
    return HN::Combine(HN::FixedTag<std::int32_t, lanes>(), high, low);
  }
}

/// In every lane the segment that its slot names, counted from list[lane].
HWY_INLINE Fields load_fields(const projection::LatticeSegment* list, const std::int32_t* slots) {
  return transposed(load_every_fourth<most_lanes>(list, slots, 0), load_every_fourth<most_lanes>(list, slots, 1),
                    load_every_fourth<most_lanes>(list, slots, 2), load_every_fourth<most_lanes>(list, slots, 3));
}

/// What a block of rows, a segment of every pixel in each, sends to the eye: numbers [row * lanes + lane].
struct LightRows {
  static constexpr std::size_t most = 32, numbers = most * most_lanes;
  alignas(64) float alpha[numbers], optical_depth[numbers], red[numbers], green[numbers], blue[numbers];
  alignas(64) std::int32_t back[numbers];
  alignas(64) std::int32_t interval[numbers];
  // The block's segments; behind the row that is worked on, those of more than one piece, until they fill the lanes.
  alignas(64) float length[numbers + most_lanes], scalar_front[numbers + most_lanes], scalar_back[numbers + most_lanes];
  alignas(64) std::int32_t place[numbers + most_lanes];
  std::size_t waiting = 0;
  bool lit[most];  ///< some lane of the row has light or depth

  HWY_INLINE void put_segment(VF l, const Fields& s, VI scalar_interval, std::size_t at) {
    const DF d;
    const DI di;
    HN::Store(l, d, length + at);
    HN::Store(s.scalar_front, d, scalar_front + at), HN::Store(s.scalar_back, d, scalar_back + at);
    HN::Store(s.back, di, back + at), HN::Store(scalar_interval, di, interval + at);
  }
  HWY_INLINE void put(const Light& light, std::size_t at) {
    const DF d;
    HN::Store(light.alpha, d, alpha + at), HN::Store(light.optical_depth, d, optical_depth + at);
    HN::Store(light.red, d, red + at), HN::Store(light.green, d, green + at), HN::Store(light.blue, d, blue + at);
  }
  HWY_INLINE void defer(MF more, std::size_t at, VF l, VF front, VF back_scalar) {
    const DF d;
    const DI di;
    const projection::HWY_NAMESPACE::LanePacker pack(HN::RebindMask(di, more));
    HN::StoreU(pack(l), d, length + waiting);
    HN::StoreU(pack(front), d, scalar_front + waiting);
    HN::StoreU(pack(back_scalar), d, scalar_back + waiting);
    HN::StoreU(pack(HN::Iota(di, static_cast<std::int32_t>(at))), di, place + waiting);
    waiting += pack.count();
  }
  template <TableForm form>
  HWY_INLINE void integrate_waiting(const Lookup<form>& table) {
    const DF d;
    alignas(64) float now[5][most_lanes];
    for (std::size_t i = 0; i < waiting; i += HN::Lanes(d)) {
      const std::size_t here = std::min(HN::Lanes(d), waiting - i);
      const Light light = integrate_lanes(table, HN::Load(d, length + i), HN::Load(d, scalar_front + i),
                                          HN::Load(d, scalar_back + i), HN::FirstN(d, here));
      HN::Store(light.alpha, d, now[0]), HN::Store(light.optical_depth, d, now[1]);
      HN::Store(light.red, d, now[2]), HN::Store(light.green, d, now[3]), HN::Store(light.blue, d, now[4]);
      for (std::size_t k = 0; k < here; ++k) {
        const auto at = static_cast<std::size_t>(place[i + k]);
        alpha[at] = now[0][k], optical_depth[at] = now[1][k];
        red[at] = now[2][k], green[at] = now[3][k], blue[at] = now[4][k];
      }
    }
    waiting = 0;
  }
};

/// The pixels [pixel, pixel + lanes) of a square.
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
        list_(windows.segments() + pixel) {}

  /// Brings keys and slots in order. Returns the number of rows: the longest list's length.
  HWY_INLINE std::size_t sort() {
    const DI d;
    const std::size_t lanes = HN::Lanes(d);
    const std::uint32_t* counts = windows_.counts() + pixel_;
    const VI count = HN::LoadU(d, reinterpret_cast<const std::int32_t*>(counts));
    const auto most = static_cast<std::size_t>(HN::GetLane(HN::MaxOfLanes(d, count)));
    const std::size_t chunks = (most + sorting::HWY_NAMESPACE::sort_chunk - 1) / sorting::HWY_NAMESPACE::sort_chunk;
    const std::size_t rows = chunks * sorting::HWY_NAMESPACE::sort_chunk;
    if (state_.keys.size() < rows * lanes) state_.keys.resize(rows * lanes), state_.slots.resize(rows * lanes);
    std::int32_t *keys = state_.keys.data(), *slots = state_.slots.data();
    for (std::size_t row = 0; row < rows; ++row) {
      const auto here = HN::Lt(HN::Set(d, static_cast<std::int32_t>(row)), count);
      VI key = HN::Set(d, no_key);
      const std::size_t slot = row * windows_.stride();
      if (row < most) {
        const auto quarter = [&](std::size_t q) HWY_ATTR {
          return HN::LoadU(d, reinterpret_cast<const std::int32_t*>(list_ + slot + q * lanes / 4));
        };
        const VI low = HN::ConcatEven(d, quarter(1), quarter(0)), high = HN::ConcatEven(d, quarter(3), quarter(2));
        key = HN::IfThenElse(here, HN::ConcatEven(d, high, low), key);
      }
      HN::StoreU(key, d, keys + row * lanes);
      HN::StoreU(HN::IfThenElseZero(here, HN::Set(d, static_cast<std::int32_t>(slot * sizeof *list_))), d,
                 slots + row * lanes);
    }
    if (chunks <= static_cast<std::size_t>(sorting::HWY_NAMESPACE::most_sort_chunks)) {
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
          settle_ties(list_ + lane, counts[lane], lanes, keys + lane, slots + lane);
        }
      }
    } else {
      for (std::size_t lane = 0; lane < lanes; ++lane)
        sort_long(list_ + lane, windows_.stride(), counts[lane], lanes, keys + lane, slots + lane);
    }
    return most;
  }

  /// The light of the rows [from, to) before `final_step`, in pixels that are open. Returns where it ended: behind the
  /// last row with a final segment.
  HWY_INLINE std::size_t integrate(std::size_t from, std::size_t to, std::int32_t final_step) {
    const DI d;
    const DF df;
    const std::size_t lanes = HN::Lanes(d);
    const VF length_per_step = HN::Load(df, &state_.length_per_step[pixel_]), zero = HN::Zero(df);
    const auto open = HN::Lt(HN::Load(d, &state_.open[pixel_]), HN::Zero(d));
    const VI end = HN::Set(d, final_step);
    // In two passes, each of chains short enough for a processor to work on several rows at once.
    for (std::size_t row = from; row < to; ++row) {
      const VI front = HN::LoadU(d, state_.keys.data() + row * lanes);
      const auto is_final = HN::Lt(front, end);
      if (HN::AllFalse(d, is_final)) {
        to = row;
        break;
      }
      const Fields s = load_fields(list_, state_.slots.data() + row * lanes);
      const VF length = HN::Mul(HN::ConvertTo(df, HN::Sub(s.back, front)), length_per_step);
      light_.put_segment(HN::IfThenElseZero(HN::RebindMask(df, HN::And(is_final, open)), length), s,
                         table_.locate(s.scalar_front, HN::Ge(s.scalar_back, s.scalar_front)), (row - from) * lanes);
    }
    for (std::size_t row = from; row < to; ++row) {
      const std::size_t at = (row - from) * lanes;
      const VF length = HN::Load(df, light_.length + at), scalar_front = HN::Load(df, light_.scalar_front + at),
               scalar_back = HN::Load(df, light_.scalar_back + at);
      MF more;
      const Light light =
          integrate_simple(table_, HN::Load(d, light_.interval + at), length, scalar_front, scalar_back, more);
      light_.put(light, at);
      MF lit = HN::Or(more, HN::Gt(light.optical_depth, zero));
      if (table_.independent) lit = HN::Or(lit, HN::Gt(HN::Add(light.red, HN::Add(light.green, light.blue)), zero));
      light_.lit[row - from] = !HN::AllFalse(df, lit);
      if (!HN::AllFalse(df, more)) light_.defer(more, at, length, scalar_front, scalar_back);
    }
    light_.integrate_waiting(table_);
    return to;
  }

  /// Composites what lies before `final_step`; returns how many segments are done with.
  HWY_INLINE std::uint64_t composite(std::size_t rows, std::int32_t final_step, const WindowRules& rules) {
    const DI d;
    const VI end = HN::Set(d, final_step);
    VI done = HN::Zero(d);
    for (std::size_t from = 0, to; from < rows; from = to) {
      const std::size_t most = std::min(rows, from + LightRows::most);
      to = integrate(from, most, final_step);
      for (std::size_t row = from; row < to; ++row)
        done = HN::Sub(done, HN::VecFromMask(d, HN::Lt(HN::LoadU(d, keys(row)), end)));
      const bool open = !rules.runs                     ? add_rows(from, to, rules)
                        : rules.least_transmittance > 0 ? add_runs<true>(from, to, end, rules)
                                                        : add_runs<false>(from, to, end, rules);
      if (to < most || !open) break;
    }
    return keep_rest(done);
  }

 private:
  HWY_INLINE static Doubles dimmed(Doubles transmittance, Doubles alpha) {
    return {HN::NegMulAdd(transmittance.low, alpha.low, transmittance.low),
            HN::NegMulAdd(transmittance.high, alpha.high, transmittance.high)};
  }
  HWY_INLINE const std::int32_t* keys(std::size_t row) const { return state_.keys.data() + row * HN::Lanes(DI()); }

  /// The rows' light into a picture's pixels. Returns whether some pixel stays open.
  HWY_INLINE bool add_rows(std::size_t from, std::size_t to, const WindowRules& rules) {
    const DI d;
    const DF df;
    const DD dd;
    const HalfF half;
    const std::size_t p = pixel_, lanes = HN::Lanes(d), half_lanes = HN::Lanes(half);
    Doubles red = load(&state_.red[p]), green = load(&state_.green[p]), blue = load(&state_.blue[p]);
    Doubles transmittance = load(&state_.transmittance[p]);
    const VD least = HN::Set(dd, rules.least_transmittance);
    const auto is_open = [&](std::size_t half_of) HWY_ATTR {
      const HN::Rebind<std::int32_t, DD> di32;
      return HN::Lt(HN::PromoteTo(dd, HN::LoadU(di32, &state_.open[p + half_of])), HN::Zero(dd));
    };
    // A pixel that closes takes no more: it has no weight.
    auto open_low = is_open(0), open_high = is_open(half_lanes);
    for (std::size_t row = from; row < to; ++row) {
      if (!light_.lit[row - from]) continue;
      const std::size_t at = (row - from) * lanes;
      const VD weight_low = HN::IfThenElseZero(open_low, transmittance.low);
      const VD weight_high = HN::IfThenElseZero(open_high, transmittance.high);
      const auto low = [&](const float* v) HWY_ATTR { return HN::PromoteTo(dd, HN::Load(half, v + at)); };
      const auto high = [&](const float* v) HWY_ATTR { return HN::PromoteTo(dd, HN::Load(half, v + at + half_lanes)); };
      const auto add = [&](Doubles& sum, const float* v) HWY_ATTR {
        sum = {HN::MulAdd(weight_low, low(v), sum.low), HN::MulAdd(weight_high, high(v), sum.high)};
      };
      add(red, light_.red), add(green, light_.green), add(blue, light_.blue);
      transmittance = {HN::NegMulAdd(weight_low, low(light_.alpha), transmittance.low),
                       HN::NegMulAdd(weight_high, high(light_.alpha), transmittance.high)};
      // After each segment, not each window: where a ray ends must not depend on how its segments were cut.
      open_low = HN::And(open_low, HN::Ge(transmittance.low, least));
      open_high = HN::And(open_high, HN::Ge(transmittance.high, least));
    }
    store(red, &state_.red[p]), store(green, &state_.green[p]), store(blue, &state_.blue[p]);
    store(transmittance, &state_.transmittance[p]);
    note_first(from, to);
    const VF closed =
        demote({HN::IfThenElseZero(open_low, HN::Set(dd, -1)), HN::IfThenElseZero(open_high, HN::Set(dd, -1))});
    const VI open = HN::ConvertTo(d, closed);
    HN::Store(open, d, &state_.open[p]);
    return !HN::AllTrue(df, HN::Ge(closed, HN::Zero(df)));
  }

  /// Where lanes that have shown nothing yet begin to. (Lanes closed by a row show what it has: it is theirs.)
  HWY_INLINE void note_first(std::size_t from, std::size_t to) {
    const DI d;
    const DF df;
    auto unseen = HN::Eq(HN::Load(d, &state_.first_back[pixel_]), HN::Set(d, no_key));
    for (std::size_t row = from; row < to && !HN::AllFalse(d, unseen); ++row) {
      if (!light_.lit[row - from]) continue;
      const VF depth = HN::Load(df, light_.optical_depth + (row - from) * HN::Lanes(d));
      const auto appears = HN::And(unseen, HN::RebindMask(d, HN::Gt(depth, HN::Zero(df))));
      if (HN::AllFalse(d, appears)) continue;
      keep_first(appears, row);
      unseen = HN::AndNot(appears, unseen);
    }
  }

  /// The same in runs, a lane's run in registers while it goes on. Returns whether some pixel stays open; that may
  /// change only where `closes`.
  template <bool closes>
  HWY_INLINE bool add_runs(std::size_t from, std::size_t to, VI end, const WindowRules& rules) {
    const DI d;
    const DF df;
    const std::size_t lanes = HN::Lanes(d);
    const std::size_t p = pixel_;
    const VI none = HN::Set(d, no_key), zero = HN::Zero(d);
    const VF least_transmittance = HN::Set(df, static_cast<float>(rules.least_transmittance));
    VI open = HN::Load(d, &state_.open[p]);
    Doubles ray = load(&state_.ray_transmittance[p]);
    VI run_back, several;
    HN::Mask<DI> seen;
    const auto resume = [&]() HWY_ATTR {
      load_light();
      run_back = HN::Load(d, &state_.back[p]), several = HN::Load(d, &state_.several[p]);
      seen = HN::Ne(HN::Load(d, &state_.first_back[p]), none);
    };
    const auto save = [&]() HWY_ATTR {
      store_light();
      HN::Store(run_back, d, &state_.back[p]), HN::Store(several, d, &state_.several[p]);
    };
    resume();
    for (std::size_t row = from; row < to; ++row) {
      const VI front = HN::LoadU(d, keys(row));
      const auto takes = HN::And(HN::Lt(front, end), HN::Lt(open, zero));
      const std::size_t at = (row - from) * lanes;
      // Lanes that took nothing from the start have no light; lanes that have closed since have.
      const auto number = [&](const float* numbers) HWY_ATTR {
        const VF all = HN::Load(df, numbers + at);
        return closes ? HN::IfThenElseZero(HN::RebindMask(df, takes), all) : all;
      };
      const VF depth = number(light_.optical_depth);
      const auto absorbs = HN::RebindMask(d, HN::Gt(depth, HN::Zero(df)));
      // Runs end where the next segment does not touch.
      const auto in_run = HN::And(takes, HN::Ne(run_back, none));
      auto ends = HN::And(in_run, HN::Gt(HN::Abs(HN::Sub(front, run_back)), HN::Set(d, touching_steps)));
      if (table_.independent) {
        // Light without extinction does not share a run with what absorbs behind it either: a run's front is where
        // absorption begins.
        const auto clear = HN::RebindMask(d, HN::Le(demote(optical_depth_), HN::Zero(df)));
        ends = HN::Or(ends, HN::And(HN::And(in_run, absorbs), HN::And(seen, clear)));
      }
      if (HWY_UNLIKELY(!HN::AllFalse(d, ends))) {
        save();
        end_runs(ends);
        resume();
      }
      // All that take one are in a run up to its back. Irregular cells' depths are a few steps off: a run does not go
      // back.
      const VI back = HN::Load(d, light_.back + at);
      const VI on = HN::IfThenElse(HN::Eq(run_back, none), back, HN::Max(run_back, back));
      run_back = HN::IfThenElse(takes, on, run_back);
      if (!light_.lit[row - from]) continue;

      const VF red = number(light_.red), green = number(light_.green), blue = number(light_.blue);
      auto shows = absorbs;
      if (table_.independent) {
        // A run begins where it shows, if only by light.
        const VF colors = HN::Add(HN::Abs(red), HN::Add(HN::Abs(green), HN::Abs(blue)));
        shows = HN::Or(shows, HN::RebindMask(d, HN::Gt(colors, HN::Zero(df))));
      }
      several = HN::Or(several, HN::VecFromMask(d, HN::And(shows, seen)));
      const auto appears = HN::AndNot(seen, shows);
      if (!HN::AllFalse(d, appears)) keep_first(appears, row);
      seen = HN::Or(seen, appears);
      red_ = multiply_add(transmittance_, promote(red), red_);
      green_ = multiply_add(transmittance_, promote(green), green_);
      blue_ = multiply_add(transmittance_, promote(blue), blue_);
      const Doubles depths = promote(depth), alphas = promote(number(light_.alpha));
      optical_depth_ = {HN::Add(optical_depth_.low, depths.low), HN::Add(optical_depth_.high, depths.high)};
      transmittance_ = dimmed(transmittance_, alphas);
      if constexpr (closes) {
        ray = dimmed(ray, alphas);
        open = HN::And(open, HN::VecFromMask(d, HN::RebindMask(d, HN::Ge(demote(ray), least_transmittance))));
      }
    }
    save();
    if constexpr (!closes) return true;
    store(ray, &state_.ray_transmittance[p]);
    HN::Store(open, d, &state_.open[p]);
    return !HN::AllFalse(d, HN::Lt(open, zero));
  }

  HWY_NOINLINE void end_runs(HN::Mask<DI> lanes) {
    std::uint8_t bits[8] = {0};
    HN::StoreMaskBits(DI(), lanes, bits);
    for (std::uint64_t left = bits[0] | static_cast<std::uint64_t>(bits[1]) << 8; left != 0; left &= left - 1)
      state_.end_run(pixel_ + static_cast<std::size_t>(__builtin_ctzll(left)));
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

  /// Notes the row's segments as those in which lanes begin to show.
  HWY_NOINLINE void keep_first(HN::Mask<DI> appears, std::size_t row) {
    const std::size_t lanes = HN::Lanes(DI());
    std::uint8_t bits[8] = {0};
    HN::StoreMaskBits(DI(), appears, bits);
    for (std::uint64_t left = bits[0] | static_cast<std::uint64_t>(bits[1]) << 8; left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctzll(left));
      const projection::LatticeSegment& s = segment_at(list_ + lane, state_.slots[row * lanes + lane]);
      const std::size_t p = pixel_ + lane;
      state_.first_front[p] = s.front, state_.first_back[p] = s.back;
      state_.first_scalar_front[p] = s.scalar_front, state_.first_scalar_back[p] = s.scalar_back;
    }
  }

  /// Leaves in the windows what was not final, in order. Returns how many segments are gone.
  HWY_INLINE std::uint64_t keep_rest(VI done) {
    const DI d;
    // Lanes beyond the last pixel share their memory with other lists.
    const std::size_t lanes = HN::Lanes(d), own = std::min(lanes, windows_.pixels() - pixel_);
    std::uint32_t* counts = windows_.counts() + pixel_;
    const VI count = HN::LoadU(d, reinterpret_cast<const std::int32_t*>(counts));
    const auto open = HN::Lt(HN::Load(d, &state_.open[pixel_]), HN::Zero(d));
    const VI left = HN::IfThenElseZero(open, HN::Sub(count, done));
    HN::StoreU(left, d, reinterpret_cast<std::int32_t*>(counts));
    const auto most = static_cast<std::size_t>(HN::GetLane(HN::MaxOfLanes(d, left)));
    const auto gone = static_cast<std::uint64_t>(HN::GetLane(HN::SumOfLanes(d, HN::Sub(count, left))));
    if (most == 0) return gone;
    // As many of each lane, so that no branch depends on one: what is not a lane's own is behind its list's end.
    alignas(64) std::int32_t first[most_lanes];
    HN::Store(done, d, first);
    if (state_.rest.size() < most * lanes) state_.rest.resize(most * lanes);
    const std::size_t last = state_.slots.size() / lanes - 1;
    for (std::size_t k = 0; k < most; ++k)
      for (std::size_t lane = 0; lane < own; ++lane) {
        const std::size_t row = std::min(static_cast<std::size_t>(first[lane]) + k, last);
        state_.rest[k * lanes + lane] = segment_at(list_ + lane, state_.slots[row * lanes + lane]);
      }
    for (std::size_t k = 0; k < most; ++k) std::copy_n(&state_.rest[k * lanes], own, list_ + k * windows_.stride());
    return gone;
  }

  const Lookup<form>& table_;
  projection::SegmentWindows& windows_;
  WindowState& state_;
  LightRows& light_;
  std::size_t pixel_;
  projection::LatticeSegment* list_;
  Doubles red_, green_, blue_, optical_depth_, transmittance_;
};

template <TableForm form>
std::uint64_t composite_form(const WindowRules& rules, projection::SegmentWindows& windows, std::int32_t final_step,
                             std::int32_t at_least, WindowState& state, scene::TraceLaps& laps) {
  const Lookup<form> lookup(*rules.table);
  std::uint64_t done = 0;
  LightRows light;
  const DI d;
  const VI few = HN::Set(d, at_least - 1);
  for (std::size_t pixel = 0; pixel < windows.pixels(); pixel += HN::Lanes(d)) {
    const VI count = HN::LoadU(d, reinterpret_cast<const std::int32_t*>(windows.counts() + pixel));
    if (HN::AllFalse(d, HN::Gt(count, few))) continue;
    PixelGroup<form> group(lookup, windows, pixel, state, light);
    const std::size_t rows = group.sort();
    laps.lap("sort");
    done += group.composite(rows, final_step, rules);
    laps.lap("integrate");
  }
  return done;
}

std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int32_t final_step,
                                std::int32_t at_least, WindowState& state, scene::TraceLaps& laps) {
  switch (form_of(*rules.table)) {
    case TableForm::one_vector:
      return composite_form<TableForm::one_vector>(rules, windows, final_step, at_least, state, laps);
    case TableForm::two_vectors:
      return composite_form<TableForm::two_vectors>(rules, windows, final_step, at_least, state, laps);
    case TableForm::many:
      break;
  }
  return composite_form<TableForm::many>(rules, windows, final_step, at_least, state, laps);
}
#endif  // HWY_SCALAR

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::compositor {
HWY_EXPORT(composite_windows);

std::uint64_t composite_windows(const WindowRules& rules, projection::SegmentWindows& windows, std::int64_t final_step,
                                std::size_t at_least, WindowState& state, scene::TraceLaps& laps) {
  const auto end = static_cast<std::int32_t>(std::clamp<std::int64_t>(final_step, -0x7fffffff, 0x7fffffff));
  const auto several = static_cast<std::int32_t>(std::clamp<std::size_t>(at_least, 1, 0x7fffffff));
  return HWY_DYNAMIC_DISPATCH(composite_windows)(rules, windows, end, several, state, laps);
}

}  // namespace tessera::compositor
#endif  // HWY_ONCE
