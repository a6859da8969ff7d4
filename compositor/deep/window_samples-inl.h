// SPDX-License-Identifier: BSD-3-Clause
// Cuts the segments of windows' rows into pieces, and merges the pieces of each pixel into deep samples. Included once
// per instruction set (Highway's include guard idiom).
//
// What      The input is rows of sorted and integrated segments, one pixel per lane (window_rows-inl.h). Pieces are
//           those of PieceCutter (compositor/deep/deep_pieces.hpp), and samples are those of DeepMerger
//           (compositor/deep/deep_fragments.hpp), for absorption without surfaces.
// How       Each pass of the loop over a row takes one piece of every lane's segment: up to the next knot of the
//           transfer function, to the end of the segment, or to where the piece's error would be too large. A piece has
//           at most one optical depth, unless what is in front hides it. A segment that is one piece has the light of
//           the row; other pieces are integrated here.
// Accuracy  Pieces and samples use the same shares of the accuracy as in double precision; float lanes add about 1e-6.
//           Depths of pieces are rounded to the lattice. A piece continues a sample that ends within touching_steps of
//           the piece's front.
// Bits      The samples of a pixel depend only on its segments, not on windows or other lanes.
// Ends      A pixel that is closed by a segment accepts no further segments, by the same rule as its light
//           (GroupLight).

#if defined(TESSERA_COMPOSITOR_DEEP_WINDOW_SAMPLES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_COMPOSITOR_DEEP_WINDOW_SAMPLES_INL_H_
#undef TESSERA_COMPOSITOR_DEEP_WINDOW_SAMPLES_INL_H_
#else
#define TESSERA_COMPOSITOR_DEEP_WINDOW_SAMPLES_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <limits>

#include "compositor/deep/window_samples.hpp"
#include "compositor/window_light-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::compositor {
namespace HWY_NAMESPACE {

using integrals::LaneTable;

/// One piece per lane.
struct PieceLanes {
  VI front, back;
  VF optical_depth, alpha;
  std::array<VF, 3> color;
};

/// The samples of the lanes' pixels while pieces are added to them (DeepMerger).
class SampleLanes {
 public:
  HWY_INLINE SampleLanes(WindowSamples& samples, std::size_t pixel) : samples_(samples), p_(pixel) {
    const DI d;
    begun_ = Load(d, &samples.begun[p_]) < Zero(d);
    front_ = Load(d, &samples.front[p_]), back_ = Load(d, &samples.back[p_]);
    each_sum([&](Doubles& lanes, double* at) HWY_ATTR { lanes = load(at); });
    each_float([&](VF& lanes, float* at) HWY_ATTR { lanes = Load(DF(), at); });
  }
  HWY_INLINE void save() {
    const DI d;
    Store(VecFromMask(d, begun_), d, &samples_.begun[p_]);
    Store(front_, d, &samples_.front[p_]), Store(back_, d, &samples_.back[p_]);
    each_sum([&](Doubles& lanes, double* at) HWY_ATTR { store(lanes, at); });
    each_float([&](VF& lanes, float* at) HWY_ATTR { Store(lanes, DF(), at); });
  }

  /// Adds pieces in the lanes `takes`. `transmittance` is the transmittance in front of them.
  HWY_INLINE void add(MI takes, PieceLanes piece, VF transmittance) {
    const DI d;
    const MI continues = And(And(takes, begun_), Not(Abs(piece.front - back_) > Set(d, touching_steps)));
    // Samples do not overlap.
    piece.front = IfThenElse(And(takes, begun_), IfThenElse(continues, back_, Max(piece.front, back_)), piece.front);
    piece.back = Max(piece.back, piece.front);
    for (VF& color : piece.color) color = Max(color, Zero(DF()));  // rounding may make a colour of zero negative
    const MI extended = extend(And(continues, back_ > front_), piece);
    const MI begins = AndNot(extended, takes);
    if (AllFalse(d, begins)) return;
    const MI ends = And(begins, begun_);
    if (!AllFalse(d, ends)) end(ends);
    begin(begins, piece, transmittance);
  }

 private:
  template <class Use>
  HWY_INLINE void each_sum(const Use& use) {
    WindowSamples& s = samples_;
    use(color_[0], &s.red[p_]), use(color_[1], &s.green[p_]), use(color_[2], &s.blue[p_]);
    use(alpha_, &s.alpha[p_]), use(depth_, &s.optical_depth[p_]);
  }
  template <class Use>
  HWY_INLINE void each_float(const Use& use) {
    WindowSamples& s = samples_;
    use(last_alpha_, &s.last_alpha[p_]), use(light_error_, &s.light_error[p_]);
    use(transmittance_error_, &s.transmittance_error[p_]);
    use(most_ratio_, &s.most_ratio[p_]), use(most_depth_, &s.most_depth[p_]);
    use(slope_low_, &s.slope_low[p_]), use(slope_high_, &s.slope_high[p_]);
    for (std::size_t c = 0; c < 3; ++c)
      use(light_low_[c], &s.light_low[c][p_]), use(light_high_[c], &s.light_high[c][p_]);
  }
  /// Returns the mask for doubles.
  HWY_INLINE static DoubleMasks in_doubles(MI mask) { return doubles(-0.5) >= promote(VecFromMask(DI(), mask)); }

  /// Adds each piece to its lane's sample if the result may still be cut anywhere. Returns these lanes.
  HWY_INLINE MI extend(MI continues, const PieceLanes& piece) {
    const DI di;
    const DF d;
    if (AllFalse(di, continues)) return continues;
    const VF one = Set(d, 1), two = Set(d, 2);
    const VF end = ConvertTo(d, piece.back - front_), per_joint = one / ConvertTo(d, back_ - front_);
    const Doubles depth_sum = depth_ + promote(piece.optical_depth), attenuation = doubles(1) - alpha_;
    const Doubles alpha_sum = MulAdd(attenuation, promote(piece.alpha), alpha_);
    const VF depth = demote(depth_sum), depth_before = demote(depth_);
    const VF alpha = demote(alpha_sum), alpha_before = demote(alpha_);
    // 2 x / (2 + x) with x = transmittance_error_ / (1 - last_alpha_)
    const VF error = Min(transmittance_error_, Set(d, 1e30f)),
             width = (error + error) / MulAdd(two, one - last_alpha_, error);
    const VF slope_low = Max(slope_low_, (depth_before - width) * per_joint);
    const VF slope_high = Min(slope_high_, (depth_before + width) * per_joint);
    MF ok = And(RebindMask(d, continues), most_depth_ >= depth);
    ok = And(ok, And(depth >= slope_low * end, slope_high * end >= depth));
    const VF per_alpha = one / alpha_before, most_light = most_ratio_ * piece.alpha;
    std::array<Doubles, 3> color_sum;
    std::array<VF, 3> low, high;
    for (std::size_t c = 0; c < 3; ++c) {
      color_sum[c] = MulAdd(attenuation, promote(piece.color[c]), color_[c]);
      const VF color = demote(color_sum[c]), before = demote(color_[c]);
      low[c] = Max(light_low_[c], (before - light_error_) * per_alpha);
      high[c] = Min(light_high_[c], (before + light_error_) * per_alpha);
      ok = And(ok, And(most_light >= piece.color[c], And(color >= low[c] * alpha, high[c] * alpha >= color)));
    }
    const MI extended = RebindMask(di, ok);
    const DoubleMasks of_sums = in_doubles(extended);
    const auto set = [&](VF& lanes, VF to) HWY_ATTR { lanes = IfThenElse(ok, to, lanes); };
    const auto add = [&](Doubles& sum, Doubles to) HWY_ATTR { sum = IfThenElse(of_sums, to, sum); };
    back_ = IfThenElse(extended, piece.back, back_);
    set(last_alpha_, alpha_before), add(alpha_, alpha_sum), add(depth_, depth_sum);
    set(slope_low_, slope_low), set(slope_high_, slope_high);
    for (std::size_t c = 0; c < 3; ++c)
      add(color_[c], color_sum[c]), set(light_low_[c], low[c]), set(light_high_[c], high[c]);
    return extended;
  }

  HWY_INLINE void begin(MI begins, const PieceLanes& piece, VF transmittance) {
    const DI di;
    const DF d;
    const MF here = RebindMask(d, begins);
    const DoubleMasks of_sums = in_doubles(begins);
    const VF one = Set(d, 1), zero = Zero(d), infinite = Set(d, std::numeric_limits<float>::infinity());
    const auto set = [&](VF& lanes, VF to) HWY_ATTR { lanes = IfThenElse(here, to, lanes); };
    const auto start = [&](Doubles& sum, VF to) HWY_ATTR { sum = IfThenElse(of_sums, promote(to), sum); };
    begun_ = Or(begun_, begins);
    front_ = IfThenElse(begins, piece.front, front_), back_ = IfThenElse(begins, piece.back, back_);
    const VF light = Max(Max(piece.color[0], piece.color[1]), piece.color[2]);
    const VF error = Set(d, samples_.merging) / transmittance, ratio = Max(one, (light + light) / piece.alpha);
    set(light_error_, error), set(most_ratio_, ratio), set(transmittance_error_, error / (one + ratio));
    // most_optical_depth(), with the whole part of the binary logarithm, a lower bound.
    const VF share = Max(one, Set(d, samples_.alpha_rounding) / ((one + ratio) * transmittance));
    const VI exponent = ShiftRight<23>(BitCast(di, Min(share, Set(d, 0x1p126f)))) - Set(di, 127);
    set(most_depth_, MulAdd(ConvertTo(d, exponent), Set(d, 0.693147f), one));
    start(alpha_, piece.alpha), start(depth_, piece.optical_depth), set(last_alpha_, zero);
    set(slope_low_, zero), set(slope_high_, infinite);
    for (std::size_t c = 0; c < 3; ++c)
      start(color_[c], piece.color[c]), set(light_low_[c], zero), set(light_high_[c], infinite);
  }

  HWY_NOINLINE void end(MI ends) {
    const DI di;
    const DF d;
    alignas(64) std::int32_t depths[2][most_lanes];
    alignas(64) float light[4][most_lanes];
    Store(front_, di, depths[0]), Store(back_, di, depths[1]);
    for (std::size_t c = 0; c < 3; ++c) Store(demote(color_[c]), d, light[c]);
    Store(demote(alpha_), d, light[3]);
    for (unsigned left = lane_bits(ends); left != 0; left &= left - 1) {
      const auto lane = static_cast<std::size_t>(__builtin_ctz(left));
      samples_.ended.push_back({static_cast<std::uint32_t>(p_ + lane), depths[0][lane], depths[1][lane], light[0][lane],
                                light[1][lane], light[2][lane], light[3][lane]});
    }
  }

  WindowSamples& samples_;
  std::size_t p_;
  MI begun_;
  VI front_, back_;
  std::array<Doubles, 3> color_;
  Doubles alpha_, depth_;
  std::array<VF, 3> light_low_, light_high_;
  VF last_alpha_, light_error_, transmittance_error_, most_ratio_, most_depth_, slope_low_, slope_high_;
};

/// Adds rows of segments to the samples of the pixels [pixel, pixel + lanes) of a square.
template <TableForm form>
class GroupSamples {
 public:
  HWY_INLINE GroupSamples(const Lookup<form>& table, const WindowState& state, const LightRows& light,
                          std::size_t pixel, WindowSamples& samples)
      : table_(table),
        light_(light),
        length_per_step_(Load(DF(), &state.length_per_step[pixel])),
        is_lit_(state.lit),
        per_share_(1 / samples.pieces),
        samples_(samples, pixel),
        transmittance_(load(&state.transmittance[pixel])),
        open_(open_pixels(state, pixel)) {}

  /// Adds the first `count` rows. Must be called before their light is added to `state`.
  HWY_NOINLINE void add(std::size_t count, double least_transmittance) {
    const DI d;
    const DF df;
    const Doubles least = doubles(least_transmittance);
    for (std::size_t row = 0; row < count; ++row) {
      if (!light_.lit[row]) continue;
      const std::size_t at = row * hn::Lanes(df);
      const MI shows = RebindMask(d, Load(df, light_.optical_depth + at) > Zero(df));
      cut(And(shows, lanes_of(open_) != Zero(d)), at);
      transmittance_ = NegMulAdd(IfThenElseZero(open_, transmittance_), load(light_.alpha + at),
                                 transmittance_);  // as RayLight::add
      open_ = And(open_, transmittance_ >= least);
    }
    samples_.save();
  }

 private:
  /// The rest of each lane's segment that is not cut yet: where it begins, and the interval of the transfer function.
  struct Rest {
    MI active;
    VI front, interval;
    VF scalar;
  };

  /// The function at one scalar of an interval.
  struct Optics {
    VF extinction;
    std::array<VF, 3> color;
  };
  template <class Index>
  HWY_INLINE Optics optics(const Index& index, VF scalar) const {
    const VF x = scalar - table_.at(LaneTable::base, index);
    const auto at = [&](int c) HWY_ATTR { return MulAdd(table_.at(c + 1, index), x, table_.at(c, index)); };
    const VF half = at(LaneTable::half_extinction);
    return {half + half, {at(LaneTable::red), at(LaneTable::green), at(LaneTable::blue)}};
  }

  /// Bounds of a stretch between two knots, which PieceCutter derives.
  struct Bounds {
    VF error;      ///< if the stretch is one piece
    VF hidden;     ///< of any piece
    VF thickness;  ///< optical depth
  };
  HWY_INLINE Bounds bounds(const Optics& a, const Optics& b, VF length, std::size_t at) const {
    const DF d;
    const VF one = Set(d, 1);
    VF change = Zero(d), most = change;
    for (std::size_t c = 0; c < 3; ++c) {
      change = Max(change, Abs(b.color[c] - a.color[c]));
      most = Max(most, Max(a.color[c], b.color[c]));
    }
    if (is_lit_) {
      const VF own = Load(d, light_.own + at);
      change = own * change, most = MulAdd(own, most, Load(d, light_.white + at));
    }
    const VF thickness = Max(a.extinction, b.extinction) * length;
    const VF bend = Abs(b.extinction - a.extinction) * length * Set(d, 0.125f);
    return {MulAdd(one + most, bend, change * thickness * Set(d, 0.25f)), one + most, thickness};
  }

  /// The end of each lane's next piece.
  struct PieceEnd {
    VI depth;
    VF scalar;
    MI finishes;  ///< whether this is the end of the stretch
  };
  /// Cuts stretches into equal pieces, if they need several.
  HWY_NOINLINE PieceEnd cut_stretch(const Rest& rest, PieceEnd end, MF is_whole, const Bounds& bounds, VF share) const {
    const DI di;
    const DF d;
    const VF span = ConvertTo(d, end.depth - rest.front), one = Set(d, 1);
    const VF count = Ceil(Max(Max(Sqrt(bounds.error * share), bounds.thickness), one));
    const VI step = Max(truncated(span / Min(count, Set(d, 1e6f))), Set(di, 1));
    const VI depth = IfThenElse(RebindMask(di, is_whole), end.depth, Min(rest.front + step, end.depth));
    const MI finishes = depth == end.depth;
    const VF along = ConvertTo(d, depth - rest.front) / Max(span, one);
    const VF scalar = MulAdd(end.scalar - rest.scalar, along, rest.scalar);
    return {depth, IfThenElse(RebindMask(d, finishes), end.scalar, scalar), finishes};
  }

  /// Cuts the segments of a row.
  HWY_INLINE void cut(MI takes, std::size_t at) {
    const DI d;
    const DF df;
    const VI front = Load(d, light_.front + at), back = Load(d, light_.back + at);
    const VF from = Load(df, light_.scalar_front + at), to = Load(df, light_.scalar_back + at);
    const MF up = to >= from;
    const Doubles steps = promote(back - front), start = promote(from), per_scalar = steps / (promote(to) - start);
    const VI direction = IfThenElse(RebindMask(d, up), Set(d, 1), Set(d, -1));
    VF transmittance = Max(demote(transmittance_), Set(df, 1e-30f));
    Rest rest{takes, front, Load(d, light_.interval + at), from};
    while (!AllFalse(d, rest.active)) {
      const auto index = table_.index(rest.interval, RebindMask(df, rest.active));
      const VF knot = table_.edge(rest.interval, index, up);
      const VF end_scalar = IfThenElse(up, Min(knot, to), Max(knot, to));
      const MF is_last = end_scalar == to;
      VI end = back;
      if (!AllTrue(d, Or(RebindMask(d, is_last), Not(rest.active)))) {
        const auto clamped = [](VD along, VD length) HWY_ATTR { return Round(Min(Max(along, Zero(DD())), length)); };
        const VI at_knot = front + in_integers(in_halves(clamped, (promote(end_scalar) - start) * per_scalar, steps));
        end = IfThenElse(RebindMask(d, is_last), back, Max(at_knot, rest.front));
      }
      const VF length = ConvertTo(df, end - rest.front) * length_per_step_, share = transmittance * Set(df, per_share_);
      const Bounds limits = bounds(optics(index, rest.scalar), optics(index, end_scalar), length, at);
      const MF is_thin = And(Set(df, 1) >= limits.error * share, Set(df, 1) >= limits.thickness);
      const MF is_whole = Or(is_thin, Set(df, 1) >= limits.hidden * share);
      PieceEnd piece_end{end, end_scalar, FirstN(d, hn::Lanes(d))};
      if (!AllTrue(df, Or(is_whole, RebindMask(df, Not(rest.active)))))
        piece_end = cut_stretch(rest, piece_end, is_whole, limits, share);
      const MI is_segment = And(And(RebindMask(d, is_last), piece_end.finishes), rest.front == front);
      PieceLanes piece = piece_of_row(rest.front, piece_end.depth, at);
      if (!AllTrue(d, Or(is_segment, Not(rest.active)))) integrate(rest, is_segment, piece_end.scalar, at, piece);
      const MI visible = And(rest.active, RebindMask(d, piece.optical_depth >= Set(df, 1e-30f)));
      samples_.add(visible, piece, transmittance);
      const VF through = transmittance * (Set(df, 1) - piece.alpha);
      transmittance = IfThenElse(RebindMask(df, visible), Max(through, Set(df, 1e-30f)), transmittance);
      rest.front = piece_end.depth, rest.scalar = piece_end.scalar;
      rest.interval = rest.interval + IfThenElseZero(And(rest.active, piece_end.finishes), direction);
      rest.active = AndNot(And(piece_end.finishes, RebindMask(d, is_last)), rest.active);
    }
  }

  /// The pieces that consist of the row's whole segments.
  HWY_INLINE PieceLanes piece_of_row(VI front, VI back, std::size_t at) const {
    const DF d;
    return {front,
            back,
            Load(d, light_.optical_depth + at),
            Load(d, light_.alpha + at),
            {Load(d, light_.red + at), Load(d, light_.green + at), Load(d, light_.blue + at)}};
  }

  /// Replaces the light of the pieces that are not whole segments.
  HWY_NOINLINE void integrate(const Rest& rest, MI is_segment, VF scalar, std::size_t at, PieceLanes& piece) const {
    const DF d;
    const MF own = RebindMask(d, AndNot(is_segment, rest.active));
    const VF length = ConvertTo(d, piece.back - piece.front) * length_per_step_;
    MF more;
    Light light = integrate_simple<false>(table_, rest.interval, length, rest.scalar, scalar, more);
    more = And(more, own);
    if (HWY_UNLIKELY(!AllFalse(d, more))) {
      const Light thick = integrate_lanes(table_, length, rest.scalar, scalar, more);
      const auto set = [&](VF& lanes, VF to) HWY_ATTR { lanes = IfThenElse(more, to, lanes); };
      set(light.alpha, thick.alpha), set(light.optical_depth, thick.optical_depth);
      set(light.red, thick.red), set(light.green, thick.green), set(light.blue, thick.blue);
    }
    const auto set = [&](VF& lanes, VF to) HWY_ATTR { lanes = IfThenElse(own, to, lanes); };
    set(piece.optical_depth, light.optical_depth), set(piece.alpha, light.alpha);
    std::array<VF, 3> color = {light.red, light.green, light.blue};
    for (std::size_t c = 0; c < 3; ++c) {
      if (is_lit_) color[c] = MulAdd(Load(d, light_.own + at), color[c], Load(d, light_.white + at) * light.alpha);
      set(piece.color[c], color[c]);
    }
  }

  const Lookup<form>& table_;
  const LightRows& light_;
  VF length_per_step_;
  bool is_lit_;
  float per_share_;  ///< the inverse of the share of the accuracy that pieces may use
  SampleLanes samples_;
  Doubles transmittance_;
  DoubleMasks open_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::compositor
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
