// SPDX-License-Identifier: BSD-3-Clause
// Composites the light of windows' rows into pixels or runs. Included once per instruction set (Highway's include guard
// idiom).
//
// What      The input is rows of integrated segments, one pixel per lane (window_rows-inl.h). GroupLight composites
//           their light C and opacity alpha front to back,
//             color += T C,  T -= T alpha,
//           where T is the transmittance so far. A run is a sequence of segments that touch: for an image, it is the
//           whole ray; for fragments, it ends where the next segment does not touch.
// Bits      Sums are in double precision, segment after segment: they depend neither on windows nor on the other lanes.
// Ends      A pixel is closed after the segment with which its T falls below the least visible transmittance; it
//           accepts no further segments.

#if defined(TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_
#undef TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_
#else
#define TESSERA_COMPOSITOR_WINDOW_LIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <span>

#include "compositor/window_rows-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::compositor {
namespace HWY_NAMESPACE {

/// Returns -1 in lanes where the mask is set, and 0 in others.
HWY_INLINE VI lanes_of(DoubleMasks mask) { return ConvertTo(DI(), demote(IfThenElseZero(mask, doubles(-1)))); }

/// The light that the lanes' rays, or runs, have accumulated so far, and their transmittance.
struct RayLight {
  Doubles red, green, blue, transmittance;

  HWY_INLINE RayLight(const WindowState& state, std::size_t p)
      : red(load(&state.red[p])),
        green(load(&state.green[p])),
        blue(load(&state.blue[p])),
        transmittance(load(&state.transmittance[p])) {}
  HWY_INLINE void save(WindowState& state, std::size_t p) const {
    store(red, &state.red[p]), store(green, &state.green[p]), store(blue, &state.blue[p]);
    store(transmittance, &state.transmittance[p]);
  }
  /// Adds the light at position `at`. `weight` is the transmittance, or zero in lanes that accept nothing.
  HWY_INLINE void add(const LightRows& light, std::size_t at, Doubles weight) {
    red = MulAdd(weight, load(light.red + at), red);
    green = MulAdd(weight, load(light.green + at), green);
    blue = MulAdd(weight, load(light.blue + at), blue);
    transmittance = NegMulAdd(weight, load(light.alpha + at), transmittance);
  }
};

/// Returns which of the pixels [pixel, pixel + lanes) are open.
HWY_INLINE DoubleMasks open_pixels(const WindowState& state, std::size_t pixel) {
  const hn::Rebind<std::int32_t, DD> di32;
  const DD dd;
  const auto half = [&](std::size_t from)
                        HWY_ATTR { return PromoteTo(dd, LoadU(di32, &state.open[pixel + from])) < Zero(dd); };
  return {half(0), half(hn::Lanes(dd))};
}

/// Adds rows of light to the rays of the pixels [pixel, pixel + lanes) of a square.
class GroupLight {
 public:
  HWY_INLINE GroupLight(WindowState& state, LightRows& light, std::size_t pixel, bool independent)
      : state_(state), light_(light), pixel_(pixel), independent_(independent) {}

  /// Adds the first `count` rows. Returns whether some pixel stays open.
  HWY_INLINE bool add(std::size_t count, const WindowRules& rules) {
    if (!rules.runs) return rules.layers == nullptr ? add_touching<false>(count, rules) : add_layers(count, rules);
    // Usually no run ends between the rows, and they are added as for an image. Independent emission also ends runs.
    if (light_.touching && !independent_) return add_touching<true>(count, rules);
    return rules.least_transmittance > 0 ? add_to_runs<true>(count, rules) : add_to_runs<false>(count, rules);
  }

 private:
  /// Adds rows that continue what each pixel has: its whole ray, or its current run.
  template <bool runs>
  HWY_INLINE bool add_touching(std::size_t count, const WindowRules& rules) {
    RayLight ray(state_, pixel_);
    const Doubles least = runs ? least_of_runs(rules) : doubles(rules.least_transmittance);
    // A closed pixel has weight zero.
    DoubleMasks open = open_pixels(state_, pixel_);
    for (std::size_t row = 0; row < count; ++row) {
      if (!light_.lit[row]) continue;
      ray.add(light_, row * hn::Lanes(DF()), IfThenElseZero(open, ray.transmittance));
      // Decided after each segment: where a ray ends must not depend on how its segments were divided into windows.
      open = And(open, ray.transmittance >= least);
    }
    ray.save(state_, pixel_);
    note_first<runs>(count);
    if constexpr (runs) Store(Load(DI(), light_.run_back), DI(), &state_.back[pixel_]);
    const VI open_lanes = store_open(open);
    return !AllFalse(DI(), open_lanes < Zero(DI()));
  }

  /// Stores the segment in which lanes that were not visible become visible and, for runs, whether more than this
  /// segment is visible. (Segments count even in lanes that an earlier segment of the row has closed.)
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

  /// The transmittance below which the lanes' runs are closed; it depends on the runs in front of them.
  HWY_INLINE Doubles least_of_runs(const WindowRules& rules) const {
    if (rules.least_transmittance == 0) return doubles(0);
    return doubles(rules.least_transmittance) / load(&state_.ray_transmittance[pixel_]);
  }

  /// The lanes' current runs while rows are added to them.
  struct Runs {
    RayLight light;
    Doubles least;     ///< transmittance below which lanes are closed
    VI back;           ///< end of the run; no_run: the lane is not in a run
    MI seen, several;  ///< whether at least one segment of the run is visible, and whether more than one is
  };
  static constexpr std::int32_t no_run = -no_key;

  template <bool closes>
  HWY_INLINE Runs resume(const WindowRules& rules) const {
    const DI d;
    const VI none = Set(d, no_key), back = Load(d, &state_.back[pixel_]);
    return {RayLight(state_, pixel_), closes ? least_of_runs(rules) : doubles(0),
            IfThenElse(back == none, Set(d, no_run), back), Load(d, &state_.first_back[pixel_]) != none,
            Load(d, &state_.several[pixel_]) != Zero(d)};
  }
  HWY_INLINE void save(const Runs& runs) {
    const DI d;
    runs.light.save(state_, pixel_);
    Store(IfThenElse(runs.back == Set(d, no_run), Set(d, no_key), runs.back), d, &state_.back[pixel_]);
    Store(VecFromMask(d, runs.several), d, &state_.several[pixel_]);
  }

  /// Adds rows to runs. Returns whether some pixel stays open; with `closes` false, no pixel is closed.
  template <bool closes>
  HWY_INLINE bool add_to_runs(std::size_t count, const WindowRules& rules) {
    const DI d;
    const DF df;
    DoubleMasks open = open_pixels(state_, pixel_);
    MI open_lanes = Load(d, &state_.open[pixel_]) < Zero(d);
    Runs runs = resume<closes>(rules);
    for (std::size_t row = 0; row < count; ++row) {
      const std::size_t at = row * hn::Lanes(d);
      const VI front = Load(d, light_.front + at);
      const MI takes = And(front != Set(d, no_key), open_lanes);
      const MI absorbs = And(takes, RebindMask(d, Load(df, light_.optical_depth + at) > Zero(df)));
      const MI ends = ending(runs, front, takes, absorbs);
      if (HWY_UNLIKELY(!AllFalse(d, ends))) {
        save(runs);
        end_runs(ends);
        runs = resume<closes>(rules);
      }
      // All lanes that take a segment are now in a run that extends to the back of this segment. The depths of
      // irregular cells differ by a few steps, so the end of a run must never decrease.
      runs.back = IfThenElse(takes, Max(runs.back, Load(d, light_.back + at)), runs.back);
      if (!light_.lit[row]) continue;
      note_shown(runs, takes, absorbs, row);
      // Lanes that took no segment from the beginning have no light; lanes that were closed since then do.
      Doubles weight = runs.light.transmittance;
      if constexpr (closes) weight = IfThenElseZero(open, weight);
      runs.light.add(light_, at, weight);
      if constexpr (closes) {
        const DoubleMasks dark = AndNot(runs.light.transmittance >= runs.least, open);
        if (HWY_UNLIKELY(!all_false(dark))) {
          open = AndNot(dark, open);
          open_lanes = store_open(open) < Zero(d);
        }
      }
    }
    save(runs);
    return !AllFalse(d, open_lanes);
  }

  /// Adds rows to layers. Returns whether some pixel stays open.
  HWY_NOINLINE bool add_layers(std::size_t count, const WindowRules& rules) {
    const DI d;
    const DF df;
    WindowLayers& layers = *rules.layers;
    RayLight ray(state_, pixel_);
    Doubles end_at = load(&layers.end_at[pixel_]), least = load(&layers.least[pixel_]);
    DoubleMasks open = open_pixels(state_, pixel_);
    MI open_lanes = Load(d, &state_.open[pixel_]) < Zero(d);
    MI seen = Load(d, &state_.first_back[pixel_]) != Set(d, no_key);
    VI last_row = Set(d, -1);
    for (std::size_t row = 0; row < count; ++row) {
      if (!light_.lit[row]) continue;
      const std::size_t at = row * hn::Lanes(d);
      const MI shows = And(open_lanes, RebindMask(d, Load(df, light_.optical_depth + at) > Zero(df)));
      const RayLight before = ray;
      ray.add(light_, at, IfThenElseZero(open, ray.transmittance));
      const MI appears = AndNot(seen, shows);
      if (!AllFalse(d, appears)) keep_first(appears, row);
      seen = Or(seen, shows);
      const MF is_thick = Load(df, light_.alpha + at) > Set(df, WindowLayers::most_alpha);
      MI ends = And(shows, lanes_of(end_at >= ray.transmittance) != Zero(d));
      if (HWY_UNLIKELY(!AllFalse(df, is_thick)))
        ends = Or(ends, And(And(shows, RebindMask(d, is_thick)), lanes_of(end_at >= doubles(0)) != Zero(d)));
      if (HWY_UNLIKELY(!AllFalse(d, ends))) {
        keep_last(last_row, layers);
        ray.save(state_, pixel_);
        end_layers(ends, before, at, layers);
        ray = RayLight(state_, pixel_);
        end_at = load(&layers.end_at[pixel_]), least = load(&layers.least[pixel_]);
        seen = Load(d, &state_.first_back[pixel_]) != Set(d, no_key);
        last_row = Set(d, -1);
      }
      last_row = IfThenElse(AndNot(ends, shows), Set(d, static_cast<std::int32_t>(row)), last_row);
      const DoubleMasks dark = AndNot(ray.transmittance >= least, open);
      if (HWY_UNLIKELY(!all_false(dark))) {
        open = AndNot(dark, open);
        open_lanes = store_open(open) < Zero(d);
      }
    }
    keep_last(last_row, layers);
    ray.save(state_, pixel_);
    return !AllFalse(d, open_lanes);
  }

  /// Lets `layers` add the segments at row position `at` of the lanes `ends`, whose light was `before`.
  HWY_NOINLINE void end_layers(MI ends, const RayLight& before, std::size_t at, WindowLayers& layers) {
    alignas(64) double red[most_lanes], green[most_lanes], blue[most_lanes], transmittance[most_lanes];
    store(before.red, red), store(before.green, green), store(before.blue, blue);
    store(before.transmittance, transmittance);
    std::array<WindowLayers::End, most_lanes> found;
    std::size_t count = 0;
    for (unsigned left = lane_bits(ends); left != 0; left &= left - 1) {
      const std::size_t lane = __builtin_ctz(left), p = pixel_ + lane, k = at + lane;
      state_.red[p] = red[lane], state_.green[p] = green[lane], state_.blue[p] = blue[lane];
      state_.transmittance[p] = transmittance[lane];
      found[count++] = {static_cast<std::uint32_t>(p),
                        {light_.front[k], light_.back[k], light_.scalar_front[k], light_.scalar_back[k]},
                        {state_.lit ? light_.own[k] : 1, state_.lit ? light_.white[k] : 0}};
    }
    layers.add(std::span(found.data(), count));
  }

  /// Stores, in lanes with `row` >= 0, this row's segment as the last one that is visible.
  HWY_INLINE void keep_last(VI row, WindowLayers& layers) {
    const DI d;
    const DF df;
    const MI has = row > Set(d, -1);
    const VI at = Max(row, Zero(d)) * Set(d, static_cast<std::int32_t>(hn::Lanes(d))) + Iota(d, 0);
    const auto keep = [&](const auto dx, const auto* from, auto* to)
                          HWY_ATTR { BlendedStore(GatherIndex(dx, from, at), RebindMask(dx, has), dx, to + pixel_); };
    keep(d, light_.front, layers.last_front.data()), keep(d, light_.back, layers.last_back.data());
    keep(df, light_.scalar_front, layers.last_scalar_front.data());
    keep(df, light_.scalar_back, layers.last_scalar_back.data());
  }

  /// Returns the lanes whose run ends because the segment that they take does not touch the back of the run.
  HWY_INLINE MI ending(const Runs& runs, VI front, MI takes, MI absorbs) const {
    const DI d;
    const MI in_run = And(takes, runs.back != Set(d, no_run));
    const MI apart = And(in_run, Abs(front - runs.back) > Set(d, touching_steps));
    if (!independent_) return apart;
    // Light without extinction does not share a run with absorption behind it, either, because the front of a run is
    // where absorption begins.
    const MI clear = lanes_of(runs.light.transmittance >= doubles(1)) != Zero(d);
    return Or(apart, And(And(in_run, absorbs), And(runs.seen, clear)));
  }

  /// Records which of the row's segments are visible in the lanes' runs.
  HWY_INLINE void note_shown(Runs& runs, MI takes, MI absorbs, std::size_t row) {
    const DI d;
    const DF df;
    MI shows = absorbs;
    if (independent_) {
      // A run begins where it becomes visible, even if it only emits light there.
      const std::size_t at = row * hn::Lanes(d);
      const auto color = [&](const float* c) HWY_ATTR { return Abs(Load(df, c + at)); };
      const VF colors = color(light_.red) + (color(light_.green) + color(light_.blue));
      shows = Or(shows, And(takes, RebindMask(d, colors > Zero(df))));
    }
    runs.several = Or(runs.several, And(shows, runs.seen));
    const MI appears = AndNot(runs.seen, shows);
    if (!AllFalse(d, appears)) keep_first(appears, row);
    runs.seen = Or(runs.seen, appears);
  }

  HWY_NOINLINE void end_runs(MI ends) {
    for (unsigned left = lane_bits(ends); left != 0; left &= left - 1)
      state_.end_run(pixel_ + static_cast<std::size_t>(__builtin_ctz(left)));
  }

  /// Stores the row's segments as those in which lanes become visible.
  HWY_NOINLINE void keep_first(MI appears, std::size_t row) {
    const DI d;
    const DF df;
    const std::size_t at = row * hn::Lanes(d), p = pixel_;
    BlendedStore(Load(d, light_.front + at), appears, d, &state_.first_front[p]);
    BlendedStore(Load(d, light_.back + at), appears, d, &state_.first_back[p]);
    const auto scalars = RebindMask(df, appears);
    BlendedStore(Load(df, light_.scalar_front + at), scalars, df, &state_.first_scalar_front[p]);
    BlendedStore(Load(df, light_.scalar_back + at), scalars, df, &state_.first_scalar_back[p]);
  }

  /// Returns the stored lanes: -1 or 0.
  HWY_INLINE VI store_open(const DoubleMasks& open) {
    const VI lanes = lanes_of(open);
    Store(lanes, DI(), &state_.open[pixel_]);
    return lanes;
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
