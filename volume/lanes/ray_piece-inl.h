// SPDX-License-Identifier: BSD-3-Clause
// The light of one stretch of a ray inside one voxel, a lane each; included once per instruction set.
//
// Field     Along a ray the trilinear field is a cubic: with v in [0, 1] over the stretch it is a straight line between
//           its ends, s_0 + v (s_1 - s_0), and a rest of mean m = (2 s_mid - s_0 - s_1) / 3, which Simpson's rule gives
//           exactly. The rest is b-shaped, -4 b ((v - 1/2)^2 - 1/4) with b = 3 m / 2, and odd,
//           p_3 v (v - 1/2) (v - 1).
// Integral  Within one interval of the transfer function extinction and colour are linear in s. The line is moved by m,
//           so that optical depth is that of the cubic, and integrated exactly (integrals/integrate_lanes-inl.h).
// Error     What is left of the rest, r, has mean zero and is of even or odd form, so its products with constant, and
//           of the even part with linear, terms vanish. There stay, per colour, |k' c'| l (4 b^2 / 45 + |b p_3| / 20
//           + |p_3 (s_1 - s_0)| / 60) from the product of extinction and colour, |k'|^2 c l^2 |r| (|s_1 - s_0| +
//           |r|) / 30 from how the rest shifts light and shadow inside the voxel. Both are below
//             l rho (rho + 0.3 |s_1 - s_0|) (0.1 |k' c'| + 0.03 |k'|^2 c l),  rho = |b| + |p_3| / 4.
//           Light of the front dims that of the back, so colour's own rest counts though k be constant: T falls by k l,
//           and its products with the odd and even part leave |c'| (k l)^2 (|p_3| / 120 + k l |b| / 90).
//           Where that exceeds the tolerance the stretch is halved: the bound falls to an eighth at least.
// Knots     A stretch that leaves its interval is cut where the cubic crosses the knot: between extrema it is monotone,
//           Newton's method, kept in its bracket, finds the place, near a touch only to 3e-4 (lane_error_bound.hpp).

#if defined(TESSERA_VOLUME_RAY_PIECE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_RAY_PIECE_INL_H_
#undef TESSERA_VOLUME_RAY_PIECE_INL_H_
#else
#define TESSERA_VOLUME_RAY_PIECE_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "volume/frame_view.hpp"
#include "volume/lanes/piece_errors-inl.h"
#include "volume/lanes/ray_cubic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// The bounds of an interval of the transfer function, already divided by the tolerance.
struct RoughnessBounds {
  VF product, shadow, dimming, extinction;
};

/// What a stretch errs, of the tolerance; see Error above.
HWY_INLINE VF roughness(VF length, VF m, VF p_3, VF span, const RoughnessBounds& bounds) {
  const DF d;
  const VF odd = Abs(p_3), even = Abs(m);
  const VF rho = MulAdd(odd, Set(d, 0.25f), even * Set(d, 1.5f));
  const VF spread = MulAdd(Abs(span), Set(d, 0.3f), rho);
  const VF scale = MulAdd(length, bounds.shadow, bounds.product);
  const VF depth = length * bounds.extinction;
  const VF dimmed = MulAdd(odd, Set(d, 1 / 120.0f), even * depth * Set(d, 1 / 60.0f));
  const VF error = MulAdd(rho * spread, scale, length * bounds.dimming * dimmed);
  return length * error;
}

/// Adds the stretches if they are smooth enough; false, and nothing added, if not.
template <bool cell_data>
HWY_INLINE bool add_uniform(const UniformLookup& table, const Piece& piece, Progress& progress) {
  const DF d;
  const VF span = piece.s_1 - piece.s_0;
  if (cell_data) {
    CL::lanes::add_piece<false>(table, 0, {piece.s_0, piece.s_1, span, piece.length}, progress);
    return true;
  }
  const VF m = (piece.s_mid + piece.s_mid - (piece.s_0 + piece.s_1)) * Set(d, 1 / 3.0f);
  const VF error = roughness(
      piece.length, m, piece.p_3, span,
      {Set(d, table.product_bound), Set(d, table.shadow_bound), Set(d, table.dimming_bound), Set(d, table.extinction)});
  if (HWY_UNLIKELY(!AllFalse(d, error > Set(d, 1.0f)))) return false;
  CL::lanes::add_piece<false>(table, 0, {piece.s_0 + m, piece.s_1 + m, span, piece.length}, progress);
  return true;
}

/// At scalar s of an interval.
template <class Lookup>
HWY_INLINE VF extinction_at(const Lookup& table, typename Lookup::Index index, VF s) {
  const VF half = MulAdd(table.at(LaneTable::half_extinction_slope, index), s - table.at(LaneTable::base, index),
                         table.at(LaneTable::half_extinction, index));
  return half + half;
}

/// How much extinction and colour change with the scalar, at most, in the interval that each lane is in.
struct FunctionSlopes {
  VF extinction, color;
};

template <class Lookup>
HWY_INLINE FunctionSlopes slopes_in(const Lookup& table, typename Lookup::Index index) {
  const auto slope = [&](int column) HWY_ATTR { return Abs(table.at(column, index)); };
  return {Set(DF(), 2.0f) * slope(LaneTable::half_extinction_slope),
          Max(Max(slope(LaneTable::red_slope), slope(LaneTable::green_slope)), slope(LaneTable::blue_slope))};
}

/// The bounds of stretches in their lanes' intervals, to which `transmittance` gets through.
template <class Lookup>
struct IntervalRoughness {
  const IntervalLanes<Lookup>& in;
  const FrameView& frame;
  VF transmittance;
  VF product, shadow, seen;

  HWY_INLINE IntervalRoughness(const IntervalLanes<Lookup>& lanes, const FrameView& of, VF per_tolerance, VF through)
      : in(lanes), frame(of), transmittance(through) {
    const DF d;
    const FunctionSlopes slope = slopes_in(in.table, in.index);
    product = in.table.independent ? Zero(d) : Set(d, 0.1f) * (slope.extinction * slope.color) * per_tolerance;
    shadow = slope.extinction * slope.extinction * Set(d, 0.03f * frame.largest_color) * per_tolerance;
    // What is dimmed already needs no care: behind 14 optical depths any of it is right.
    seen = per_tolerance * (slope.color * transmittance);
  }
  /// Between two places where the field does not turn: extinction is largest at one of them.
  HWY_INLINE RoughnessBounds between(VF s_0, VF s_1) const {
    const VF most = Max(extinction_at(in.table, in.index, s_0), extinction_at(in.table, in.index, s_1));
    return {product, shadow, seen * (in.table.independent ? most : most * most), most};
  }
};

/// Where the cubic, monotone from one place to the next, leaves its interval, or else the latter place. `up`: it rises.
template <class Lookup>
HWY_INLINE CubicPlace cut_at_knot(const IntervalLanes<Lookup>& in, const Cubic& c, const CubicPlace& from,
                                  const CubicPlace& to, MF up) {
  const VI to_far_edge = IfThenElseZero(RebindMask(DI(), up), Set(DI(), 1));
  const VF knot = in.table.edge(in.interval, in.index, to_far_edge);
  const MF crosses = And(in.wanted, Or(And(up, knot < to.s), AndNot(up, knot > to.s)));
  if (AllFalse(DF(), crosses)) return to;
  const VF at_knot = find_crossing(c, from, to, knot, crosses);
  return {IfThenElse(crosses, at_knot, to.v), IfThenElse(crosses, knot, to.s)};
}

/// The front of a stretch that is smooth enough for a line: where it ends, its mean rest m, and its length.
struct SmoothPart {
  VF v, s;  ///< its end
  VF m, length;
};

/// A stretch is halved no more often; 4096 of an optical depth of 1e4 are still thin.
constexpr int most_halvings = 12;

/// Of the cubic between two places: halved until it errs no more than the tolerance. `length` is the whole cubic's.
/// `left` gets what even then is not smooth, as it is seen.
template <class Lookup>
HWY_INLINE SmoothPart smooth_part(const IntervalRoughness<Lookup>& in, const Cubic& c, VF length,
                                  const CubicPlace& from, const CubicPlace& to, VF& left) {
  const DF d;
  const VF half = Set(d, 0.5f), one = Set(d, 1.0f);
  SmoothPart part;
  part.v = to.v, part.s = to.s;
  for (int halvings = 0;; ++halvings) {
    const VF extent = part.v - from.v, middle = MulAdd(half, extent, from.v), s_middle = c.at(middle);
    part.m = (s_middle + s_middle - (from.s + part.s)) * Set(d, 1 / 3.0f);
    part.length = IfThenElseZero(in.in.wanted, extent * length);
    const VF p_3 = c.p_3 * (extent * (extent * extent));
    const VF error = roughness(part.length, part.m, p_3, part.s - from.s, in.between(from.s, part.s));
    const MF rough = error > one;
    if (AllFalse(d, rough)) break;
    if (HWY_UNLIKELY(halvings == most_halvings)) {
      const VF capped = Min(error * Set(d, in.frame.piece_tolerance), one);
      left = MulAdd(IfThenElseZero(rough, capped), in.transmittance, left);
      break;
    }
    part.v = IfThenElse(rough, middle, part.v);
    part.s = IfThenElse(rough, s_middle, part.s);
  }
  return part;
}

/// Stretches that cross knots, are rough, or whose lanes are in different intervals, and what they may err: a bound, or
/// `closely`, where `progress` is that of the stretch alone. NaN samples are blank.
template <bool closely, class Lookup>
HWY_NOINLINE StretchErrors walk_cubic(const Lookup& table, const FrameView& frame, const Piece& piece,
                                      Progress& progress, RayNotes& notes, std::uint64_t& pieces) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  MF active = And(piece.length > zero, piece.s_mid == piece.s_mid);
  StretchErrors errors{zero, zero, zero};
  if (AllFalse(d, active)) return errors;
  [[maybe_unused]] Excess excess;
  if (closely) excess = {zero, zero, zero, zero, zero, zero, zero, zero};
  auto& of_steps = *[&] {
    if constexpr (closely)
      return &excess;
    else
      return &errors;
  }();
  const Cubic c = cubic_of(piece, active);
  const Turns turns(c, active);
  const VF per_tolerance = Set(d, 1 / frame.piece_tolerance);
  const VF s_1 = IfThenElseZero(active, piece.s_1);
  const bool has_steps = frame.error_bound != nullptr && !frame.error_bound->step.empty();
  const float* const ramps =
      frame.error_bound != nullptr && !frame.error_bound->ramp.empty() ? frame.error_bound->ramp.data() : nullptr;
  CubicPlace at{zero, c.p_0};
  // Each round ends at a knot, an extremum, a halving or the stretch's end; knots are few but for wild functions.
  for (int round = 0; round < 4096; ++round) {
    const VF turn = turns.after(at.v);
    const CubicPlace to{turn, IfThenElse(turn == one, s_1, c.at(turn))};
    const MF up = to.s >= at.s;
    const VI interval = table.locate(at.s, up);
    const auto index = table.index(interval, active);
    // Made again for functions that are not inlined: what these refer to is kept in memory.
    const auto lanes_in = [&](MF lanes) HWY_ATTR {
      return IntervalLanes<Lookup>{table, index, interval, lanes, frame.error_bound};
    };
    const IntervalLanes<Lookup> in = lanes_in(active);
    const VF before = progress.transmittance;
    const SmoothPart part = smooth_part(IntervalRoughness<Lookup>(in, frame, per_tolerance, before), c, piece.length,
                                        at, cut_at_knot(in, c, at, to, up), errors.left);
    pieces += CountTrue(d, active);
    if (HWY_UNLIKELY(round == 0 && has_steps))
      add_step_error(lanes_in(active), Cubic(c), {at.v, at.s}, piece.length, progress, of_steps);
    CL::lanes::add_piece<false>(table, index, {at.s + part.m, part.s + part.m, part.s - at.s, part.length}, progress);
    note_first_light(progress, MulAdd(at.v, piece.extent, piece.begin), notes);
    if (HWY_UNLIKELY(has_steps))
      add_step_error(lanes_in(active), Cubic(c), {part.v, part.s}, piece.length, progress, of_steps);
    if (ramps != nullptr) {
      // Lanes that are done have an interval and no length.
      const VF ramp = GatherIndex(d, ramps, interval);
      if (!closely) {
        errors.ramps = MulAdd(part.length * before, ramp, errors.ramps);
      } else if (const MF steep = And(active, ramp > zero); !AllFalse(d, steep)) {
        add_ramp_excess(lanes_in(steep), part.s, part.length, before, progress, excess);
      }
    }
    at = {IfThenElse(active, part.v, at.v), IfThenElse(active, part.s, at.s)};
    active = And(active, at.v < one);
    if (AllFalse(d, active)) break;
  }
  // Rounds that do not do.
  errors.left = errors.left + IfThenElseZero(active, progress.transmittance);
  if (closely) set_close_errors(excess, progress, *frame.error_bound, errors);
  return errors;
}

/// Adds stretches that cross knots, are rough, or whose lanes are in different intervals, and notes what they may err.
template <class Lookup>
HWY_INLINE void add_any(const Lookup& table, const FrameView& frame, const Piece& piece, Progress& progress,
                        RayNotes& notes, std::uint64_t& pieces) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f), before = progress.transmittance;
  StretchErrors errors = walk_cubic<false>(table, frame, piece, progress, notes, pieces);
  if (HWY_LIKELY(frame.error_bound == nullptr)) return;
  const MF matters = errors.steps + errors.ramps > Set(d, frame.error_bound->matters);
  if (HWY_UNLIKELY(!AllFalse(d, matters))) {
    Progress alone{zero, one, zero, zero, zero, zero};
    RayNotes none{zero, zero == zero, zero, zero};
    std::uint64_t again = 0;
    const StretchErrors close = walk_cubic<true>(table, frame, piece, alone, none, again);
    const auto less = [&](VF far, VF near) HWY_ATTR { return Min(far, before * near); };
    const VF ramps = less(errors.ramps, close.ramps);
    errors.steps = Min(errors.steps + (errors.ramps - ramps), before * close.steps);
    errors.ramps = ramps;
  }
  const VF steady = Set(d, frame.error_bound->steady);
  notes.error_bound = notes.error_bound + (errors.left + MulAdd(errors.ramps, steady, errors.steps));
  notes.rough = MulAdd(errors.ramps, errors.ramps, notes.rough);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
