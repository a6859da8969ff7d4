// SPDX-License-Identifier: BSD-3-Clause
// The light of windows' rows on its way into pixels, or runs; included once per instruction set (Highway's include
// guard idiom).

#if defined(TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_
#undef TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_
#else
#define TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <span>

#include "compositor/surface_lights-inl.h"
#include "compositor/window_kernel.hpp"
#include "scene/lanes/pack_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::compositor {
namespace HWY_NAMESPACE {

constexpr std::int32_t no_key = WindowState::not_yet;  // behind all keys

/// -1 where the mask is set, else 0.
HWY_INLINE VI lanes_of(hn::Mask<DD> low, hn::Mask<DD> high) {
  const VD yes = Set(DD(), -1);
  return ConvertTo(DI(), demote({IfThenElseZero(low, yes), IfThenElseZero(high, yes)}));
}

/// What a block of rows, a segment of every pixel in each, sends to the eye: numbers [row * lanes + lane].
struct LightRows {
  static constexpr std::size_t most = 32, numbers = most * most_lanes;
  alignas(64) float alpha[numbers], optical_depth[numbers], red[numbers], green[numbers], blue[numbers];
  /// Of the segment, in lattice steps; front is no_key where the row has none that counts.
  alignas(64) std::int32_t front[numbers], back[numbers];
  alignas(64) std::int32_t interval[numbers];
  alignas(64) float length[numbers], scalar_front[numbers], scalar_back[numbers];
  // Where segments of more than one piece are, until they fill the lanes.
  alignas(64) std::int32_t waiting_at[numbers + most_lanes];
  std::size_t waiting = 0;
  bool lit[most];  ///< some lane of the row has light or depth
  // Runs: where each lane's ends behind the rows (no_key: in none), and whether none ends between them.
  alignas(64) std::int32_t run_back[most_lanes];
  bool touching;
  // Segments that begin at a surface: where they are and their marks while they are integrated, and the rows that have
  // some, a bit each.
  alignas(64) std::int32_t marked_at[numbers + most_lanes];
  alignas(64) float mark[numbers + most_lanes];
  std::size_t marked = 0;
  std::uint32_t marked_rows = 0;

  /// Of a row, whose lanes that are final and open take a segment. Returns its front scalars, with the surfaces' values
  /// where they are marks.
  HWY_INLINE VF set_aside_surfaces(std::span<const float> by_number, hn::Mask<DI> is_final, hn::Mask<DI> open,
                                   VF scalar_from, std::size_t row) {
    using Mark = projection::LatticeMark;
    const DF d;
    const DI di;
    const MF is_mark = And(RebindMask(d, is_final), scalar_from >= Set(d, Mark::first));
    if (AllFalse(d, is_mark)) return scalar_from;
    const auto takes = And(RebindMask(di, is_mark), open);
    const scene::HWY_NAMESPACE::LanePacker pack(takes);
    if (pack.count() > 0) {
      StoreU(pack(Iota(di, 0) + Set(di, static_cast<std::int32_t>(row * hn::Lanes(d)))), di, marked_at + marked);
      StoreU(pack(scalar_from), d, mark + marked);
      marked += pack.count();
      marked_rows |= 1u << row;
    }
    const VI last = Set(di, static_cast<std::int32_t>(by_number.size()) - 1);
    const VI number = IfThenElseZero(RebindMask(di, is_mark), Min(number_of(scalar_from), last));
    return IfThenElse(is_mark, GatherIndex(d, by_number.data(), number), scalar_from);
  }
  /// After integrate(): puts the surfaces before what is behind them. `show_first`: where lanes begin to show may still
  /// be asked.
  HWY_NOINLINE void put_surfaces(const scene::SurfaceSet& surfaces, bool show_first) {
    const DF d;
    const DI di;
    for (std::size_t i = 0; i < marked; i += hn::Lanes(d)) {
      // Lanes beyond the last do as the first does.
      const auto here = FirstN(d, marked - i);
      const VI at = IfThenElse(RebindMask(di, here), Load(di, marked_at + i), Set(di, marked_at[i]));
      const VF marks = IfThenElse(here, Load(d, mark + i), Set(d, mark[i]));
      const SurfaceLights light(surfaces, marks);
      const auto put = [&](const Doubles& of_surface, float* to) HWY_ATTR {
        const VF sum = demote(light.before(of_surface, promote(GatherIndex(d, to, at))));
        ScatterIndex(sum, d, to, at);
        return sum;
      };
      put(light.red, red), put(light.green, green), put(light.blue, blue);
      const VF hidden = put(light.opacity, alpha);
      if (!show_first) continue;
      // Of the optical depth is only asked whether there is some.
      ScatterIndex(hidden, d, optical_depth, at);
      ScatterIndex(marks, d, scalar_front, at);
    }
    for (; marked_rows != 0; marked_rows &= marked_rows - 1) lit[__builtin_ctz(marked_rows)] = true;
    marked = 0;
  }

  HWY_INLINE void put_segment(VF l, VI from, VI to, VF scalar_from, VF scalar_to, VI scalar_interval, std::size_t at) {
    const DF d;
    const DI di;
    Store(l, d, length + at);
    Store(scalar_from, d, scalar_front + at), Store(scalar_to, d, scalar_back + at);
    Store(from, di, front + at), Store(to, di, back + at), Store(scalar_interval, di, interval + at);
  }
  HWY_INLINE void put(const Light& light, std::size_t at) {
    const DF d;
    Store(light.alpha, d, alpha + at), Store(light.optical_depth, d, optical_depth + at);
    Store(light.red, d, red + at), Store(light.green, d, green + at), Store(light.blue, d, blue + at);
  }
  HWY_INLINE void defer(MF more, VI places) {
    const DI d;
    const scene::HWY_NAMESPACE::LanePacker pack(RebindMask(d, more));
    StoreU(pack(places), d, waiting_at + waiting);
    waiting += pack.count();
  }
  template <TableForm form>
  HWY_INLINE void integrate_waiting(const Lookup<form>& table) {
    const DF d;
    const DI di;
    alignas(64) float now[5][most_lanes];
    StoreU(Zero(di), di, waiting_at + waiting);  // lanes beyond the last read some place, too
    for (std::size_t i = 0; i < waiting; i += hn::Lanes(d)) {
      const std::size_t here = std::min(hn::Lanes(d), waiting - i);
      const VI at = Load(di, waiting_at + i);
      const Light light = integrate_lanes(table, GatherIndex(d, length, at), GatherIndex(d, scalar_front, at),
                                          GatherIndex(d, scalar_back, at), FirstN(d, here));
      Store(light.alpha, d, now[0]), Store(light.optical_depth, d, now[1]);
      Store(light.red, d, now[2]), Store(light.green, d, now[3]), Store(light.blue, d, now[4]);
      for (std::size_t k = 0; k < here; ++k) {
        const auto to = static_cast<std::size_t>(waiting_at[i + k]);
        alpha[to] = now[0][k], optical_depth[to] = now[1][k];
        red[to] = now[2][k], green[to] = now[3][k], blue[to] = now[4][k];
      }
    }
    waiting = 0;
  }

  /// The light of the first `count` rows' segments.
  template <TableForm form>
  HWY_INLINE void integrate(const Lookup<form>& table, std::size_t count) {
    table.independent ? integrate_rows<true>(table, count) : integrate_rows<false>(table, count);
    integrate_waiting(table);
  }

 private:
  template <bool independent, TableForm form>
  HWY_INLINE void integrate_rows(const Lookup<form>& table, std::size_t count) {
    const DI d;
    const DF df;
    const std::size_t lanes = hn::Lanes(d);
    VI places = Iota(d, 0);
    for (std::size_t row = 0; row < count; ++row) {
      const std::size_t at = row * lanes;
      const VF l = Load(df, length + at), from = Load(df, scalar_front + at), to = Load(df, scalar_back + at);
      MF more;
      const Light light = integrate_simple<independent>(table, Load(d, interval + at), l, from, to, more);
      put(light, at);
      MF shows = Or(more, light.optical_depth > Zero(df));
      if constexpr (independent) shows = Or(shows, light.red + (light.green + light.blue) > Zero(df));
      lit[row] = !AllFalse(df, shows);
      if (!AllFalse(df, more)) defer(more, places);
      places = places + Set(d, static_cast<std::int32_t>(lanes));
    }
  }
};

/// Adds rows of light to the rays of the pixels [pixel, pixel + lanes) of a square.
class GroupLight {
 public:
  HWY_INLINE GroupLight(WindowState& state, LightRows& light, std::size_t pixel, bool independent)
      : state_(state), light_(light), pixel_(pixel), independent_(independent) {}

  /// The first `count` rows. Returns whether some pixel stays open.
  HWY_INLINE bool add(std::size_t count, const WindowRules& rules) {
    if (!rules.runs) return add_touching<false>(count, rules);
    // Mostly no run ends between the rows: then they are a picture's. Light without extinction ends runs, too.
    if (light_.touching && !independent_) return add_touching<true>(count, rules);
    return rules.least_transmittance > 0 ? add_to_runs<true>(count, rules) : add_to_runs<false>(count, rules);
  }

 private:
  /// Rows that go on with what each pixel has: with the whole picture, or with its run.
  template <bool runs>
  HWY_INLINE bool add_touching(std::size_t count, const WindowRules& rules) {
    const DF df;
    const DD dd;
    const std::size_t p = pixel_;
    Doubles red = load(&state_.red[p]), green = load(&state_.green[p]), blue = load(&state_.blue[p]);
    Doubles transmittance = load(&state_.transmittance[p]);
    const Doubles least =
        runs ? least_of_runs(rules) : Doubles{Set(dd, rules.least_transmittance), Set(dd, rules.least_transmittance)};
    // A pixel that closes takes no more: it has no weight.
    Open open = load_open();
    for (std::size_t row = 0; row < count; ++row) {
      if (!light_.lit[row]) continue;
      const std::size_t at = row * hn::Lanes(df);
      const Doubles weight{IfThenElseZero(open.low, transmittance.low), IfThenElseZero(open.high, transmittance.high)};
      add(weight, light_.red + at, red), add(weight, light_.green + at, green), add(weight, light_.blue + at, blue);
      take(weight, light_.alpha + at, transmittance);
      // After each segment, not each window: where a ray ends must not depend on how its segments were cut.
      open.low = And(open.low, transmittance.low >= least.low);
      open.high = And(open.high, transmittance.high >= least.high);
    }
    store(red, &state_.red[p]), store(green, &state_.green[p]), store(blue, &state_.blue[p]);
    store(transmittance, &state_.transmittance[p]);
    note_first<runs>(count);
    if constexpr (runs) Store(Load(DI(), light_.run_back), DI(), &state_.back[p]);
    const VI open_lanes = store_open(open);
    return !AllFalse(DI(), open_lanes < Zero(DI()));
  }

  /// Where lanes that have shown nothing yet begin to, and, of runs, whether more than that segment shows. (Lanes
  /// closed by a row show what it has: it is theirs.)
  template <bool runs>
  HWY_INLINE void note_first(std::size_t count) {
    const DI d;
    const DF df;
    auto unseen = Load(d, &state_.first_back[pixel_]) == Set(d, no_key);
    auto single = unseen;
    if constexpr (runs) single = Load(d, &state_.several[pixel_]) == Zero(d);
    for (std::size_t row = 0; row < count && !AllFalse(d, single); ++row) {
      if (!light_.lit[row]) continue;
      const VF depth = Load(df, light_.optical_depth + row * hn::Lanes(d));
      const auto shows = RebindMask(d, depth > Zero(df));
      const auto appears = And(unseen, shows);
      if constexpr (runs) single = AndNot(AndNot(unseen, shows), single);
      if (AllFalse(d, appears)) continue;
      keep_first(appears, row);
      unseen = AndNot(appears, unseen);
      if constexpr (!runs) single = unseen;
    }
    if constexpr (runs) Store(VecFromMask(d, Not(single)), d, &state_.several[pixel_]);
  }

  /// What the lanes' runs must let through to stay open, behind the runs before them.
  HWY_INLINE Doubles least_of_runs(const WindowRules& rules) const {
    const DD d;
    if (rules.least_transmittance == 0) return {Zero(d), Zero(d)};
    const Doubles before = load(&state_.ray_transmittance[pixel_]);
    const VD most = Set(d, rules.least_transmittance);
    return {most / before.low, most / before.high};
  }

  /// The same in runs, a lane's run in registers while it goes on. Whether some pixel stays open may change only where
  /// `closes`.
  // Long: one loop over rows whose state stays in registers; a part of it would get that state through memory.
  template <bool closes>
  HWY_INLINE bool add_to_runs(std::size_t count, const WindowRules& rules) {
    const DI d;
    const DF df;
    const DD dd;
    const std::size_t p = pixel_;
    const VI none = Set(d, no_key), no_run = Set(d, -no_key), zero = Zero(d);
    Doubles red, green, blue, transmittance, least;
    VI run_back;  // no_run: no run
    hn::Mask<DI> seen, several;
    const auto resume = [&]() HWY_ATTR {
      red = load(&state_.red[p]), green = load(&state_.green[p]), blue = load(&state_.blue[p]);
      transmittance = load(&state_.transmittance[p]);
      if constexpr (closes) least = least_of_runs(rules);
      run_back = Load(d, &state_.back[p]);
      run_back = IfThenElse(run_back == none, no_run, run_back);
      several = Load(d, &state_.several[p]) != zero;
      seen = Load(d, &state_.first_back[p]) != none;
    };
    const auto save = [&]() HWY_ATTR {
      store(red, &state_.red[p]), store(green, &state_.green[p]), store(blue, &state_.blue[p]);
      store(transmittance, &state_.transmittance[p]);
      Store(IfThenElse(run_back == no_run, none, run_back), d, &state_.back[p]);
      Store(VecFromMask(d, several), d, &state_.several[p]);
    };
    Open open = load_open();
    auto open_lanes = Load(d, &state_.open[p]) < zero;
    resume();
    for (std::size_t row = 0; row < count; ++row) {
      const std::size_t at = row * hn::Lanes(d);
      const VI front = Load(d, light_.front + at);
      const auto takes = And(front != none, open_lanes);
      const auto absorbs = And(takes, RebindMask(d, Load(df, light_.optical_depth + at) > Zero(df)));
      // Runs end where the next segment does not touch.
      const auto in_run = And(takes, run_back != no_run);
      auto ends = And(in_run, Abs(front - run_back) > Set(d, touching_steps));
      if (independent_) {
        // Light without extinction does not share a run with what absorbs behind it either: a run's front is where
        // absorption begins.
        const VD one = Set(dd, 1);
        const auto clear = lanes_of(transmittance.low >= one, transmittance.high >= one) != zero;
        ends = Or(ends, And(And(in_run, absorbs), And(seen, clear)));
      }
      if (HWY_UNLIKELY(!AllFalse(d, ends))) {
        save();
        end_runs(ends);
        resume();
      }
      // All that take one are in a run up to its back. Irregular cells' depths are a few steps off: a run does not go
      // back.
      run_back = IfThenElse(takes, Max(run_back, Load(d, light_.back + at)), run_back);
      if (!light_.lit[row]) continue;

      auto shows = absorbs;
      if (independent_) {
        // A run begins where it shows, if only by light.
        const auto color = [&](const float* c) HWY_ATTR { return Abs(Load(df, c + at)); };
        const VF colors = color(light_.red) + (color(light_.green) + color(light_.blue));
        shows = Or(shows, And(takes, RebindMask(d, colors > Zero(df))));
      }
      several = Or(several, And(shows, seen));
      const auto appears = AndNot(seen, shows);
      if (!AllFalse(d, appears)) keep_first(appears, row);
      seen = Or(seen, appears);
      // Lanes that took nothing from the start have no light; lanes that have closed since have.
      Doubles weight = transmittance;
      if constexpr (closes) weight = {IfThenElseZero(open.low, weight.low), IfThenElseZero(open.high, weight.high)};
      add(weight, light_.red + at, red), add(weight, light_.green + at, green), add(weight, light_.blue + at, blue);
      take(weight, light_.alpha + at, transmittance);
      if constexpr (closes) {
        const auto dark_low = AndNot(transmittance.low >= least.low, open.low);
        const auto dark_high = AndNot(transmittance.high >= least.high, open.high);
        if (HWY_UNLIKELY(!AllFalse(dd, Or(dark_low, dark_high)))) {
          open = {AndNot(dark_low, open.low), AndNot(dark_high, open.high)};
          open_lanes = store_open(open) < zero;
        }
      }
    }
    save();
    return !AllFalse(d, open_lanes);
  }

  HWY_NOINLINE void end_runs(hn::Mask<DI> lanes) {
    std::uint8_t bits[8] = {0};
    StoreMaskBits(DI(), lanes, bits);
    for (std::uint64_t left = bits[0] | static_cast<std::uint64_t>(bits[1]) << 8; left != 0; left &= left - 1)
      state_.end_run(pixel_ + static_cast<std::size_t>(__builtin_ctzll(left)));
  }

  /// Notes the row's segments as those in which lanes begin to show.
  HWY_NOINLINE void keep_first(hn::Mask<DI> appears, std::size_t row) {
    const DI d;
    const DF df;
    const std::size_t at = row * hn::Lanes(d), p = pixel_;
    BlendedStore(Load(d, light_.front + at), appears, d, &state_.first_front[p]);
    BlendedStore(Load(d, light_.back + at), appears, d, &state_.first_back[p]);
    const auto scalars = RebindMask(df, appears);
    BlendedStore(Load(df, light_.scalar_front + at), scalars, df, &state_.first_scalar_front[p]);
    BlendedStore(Load(df, light_.scalar_back + at), scalars, df, &state_.first_scalar_back[p]);
  }

  using HalfMask = hn::Mask<DD>;
  struct Open {
    HalfMask low, high;
  };
  HWY_INLINE Open load_open() const {
    const hn::Rebind<std::int32_t, DD> di32;
    const DD dd;
    const auto half = [&](std::size_t from)
                          HWY_ATTR { return PromoteTo(dd, LoadU(di32, &state_.open[pixel_ + from])) < Zero(dd); };
    return {half(0), half(hn::Lanes(dd))};
  }
  /// Returns what is stored: -1 or 0.
  HWY_INLINE VI store_open(const Open& open) {
    const DI d;
    const VI lanes = lanes_of(open.low, open.high);
    Store(lanes, d, &state_.open[pixel_]);
    return lanes;
  }
  /// sum += weight * v, transmittance -= weight * alpha.
  HWY_INLINE static void add(Doubles weight, const float* v, Doubles& sum) {
    const Doubles x = load(v);
    sum = {MulAdd(weight.low, x.low, sum.low), MulAdd(weight.high, x.high, sum.high)};
  }
  HWY_INLINE static void take(Doubles weight, const float* alpha, Doubles& transmittance) {
    const Doubles x = load(alpha);
    transmittance = {NegMulAdd(weight.low, x.low, transmittance.low),
                     NegMulAdd(weight.high, x.high, transmittance.high)};
  }

  WindowState& state_;
  LightRows& light_;
  std::size_t pixel_;
  bool independent_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
