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

/// Whether a stretch errs more than the tolerance.
HWY_INLINE MF too_rough(VF length, VF m, VF p_3, VF span, const RoughnessBounds& bounds) {
  return roughness(length, m, p_3, span, bounds) > Set(DF(), 1.0f);
}

/// Adds the stretches if they are smooth enough; false, and nothing added, if not.
template <bool cell_data>
HWY_INLINE bool add_uniform(const UniformLookup& table, const Piece& piece, Progress& progress) {
  const DF d;
  const VF span = piece.s_1 - piece.s_0;
  if (cell_data) {
    CL::lanes::add_piece<false>(table, 0, piece.s_0, piece.s_1, span, piece.length, progress);
    return true;
  }
  const VF m = (piece.s_mid + piece.s_mid - (piece.s_0 + piece.s_1)) * Set(d, 1 / 3.0f);
  const MF rough = too_rough(
      piece.length, m, piece.p_3, span,
      {Set(d, table.product_bound), Set(d, table.shadow_bound), Set(d, table.dimming_bound), Set(d, table.extinction)});
  if (HWY_UNLIKELY(!AllFalse(d, rough))) return false;
  CL::lanes::add_piece<false>(table, 0, piece.s_0 + m, piece.s_1 + m, span, piece.length, progress);
  return true;
}

/// At scalar s of an interval.
template <class Lookup>
HWY_INLINE VF extinction_at(const Lookup& table, typename Lookup::Index index, VF s) {
  const VF half = MulAdd(table.at(LaneTable::half_extinction_slope, index), s - table.at(LaneTable::base, index),
                         table.at(LaneTable::half_extinction, index));
  return half + half;
}

/// A stretch is halved no more often; 4096 of an optical depth of 1e4 are still thin.
constexpr int most_halvings = 12;

/// Stretches that cross knots, are rough, or whose lanes are in different intervals, and what they may err: a bound, or
/// `closely`, where `progress` is that of the stretch alone. NaN samples are blank.
// Long: a round's values stay in registers; its parts as inlined functions cost 1.3 % of its instructions.
template <bool closely, class Lookup>
HWY_NOINLINE StretchErrors walk_cubic(const Lookup& table, const FrameView& frame, const Piece& piece,
                                      Progress& progress, RayNotes& notes, std::uint64_t& pieces) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f), half = Set(d, 0.5f);
  MF active = And(piece.length > zero, piece.s_mid == piece.s_mid);
  ErrorSums sums{{zero, zero, zero}, {zero, zero, zero, zero, zero, zero, zero, zero}};
  StretchErrors& errors = sums.bounds;
  if (AllFalse(d, active)) return errors;
  const Cubic c = cubic_of(piece, active);
  const VF s_0 = c.p_0, s_1 = IfThenElseZero(active, piece.s_1), p_3 = c.p_3;
  VF turn_1 = one, turn_2 = one;
  if (!AllFalse(d, AndNot(is_monotone(c), active))) find_extrema(c, turn_1, turn_2);

  const VF per_tolerance = Set(d, 1 / frame.piece_tolerance);
  const bool has_steps = frame.error_bound != nullptr && !frame.error_bound->step.empty();
  const float* const ramps =
      frame.error_bound != nullptr && !frame.error_bound->ramp.empty() ? frame.error_bound->ramp.data() : nullptr;
  VF v = zero, s = s_0;
  // Each round ends at a knot, an extremum, a halving or the stretch's end; knots are few but for wild functions.
  for (int round = 0; round < 4096; ++round) {
    const VF turn = IfThenElse(v < turn_1, turn_1, IfThenElse(v < turn_2, turn_2, one));
    const VF s_turn = IfThenElse(turn == one, s_1, c.at(turn));
    const MF up = s_turn >= s;
    const VI to_far_edge = IfThenElseZero(RebindMask(DI(), up), Set(DI(), 1));
    const VI interval = table.locate(s, up);
    const auto index = table.index(interval, active);
    const VF knot = table.edge(interval, index, to_far_edge);
    const MF crosses = And(active, Or(And(up, knot < s_turn), AndNot(up, knot > s_turn)));
    VF end = turn, s_end = s_turn;
    if (!AllFalse(d, crosses)) {
      const VF at_knot = find_crossing(c, v, turn, s, s_turn, knot, crosses);
      end = IfThenElse(crosses, at_knot, end);
      s_end = IfThenElse(crosses, knot, s_end);
    }
    const VF slope = Set(d, 2.0f) * Abs(table.at(LaneTable::half_extinction_slope, index));
    const VF color_slope =
        Max(Max(Abs(table.at(LaneTable::red_slope, index)), Abs(table.at(LaneTable::green_slope, index))),
            Abs(table.at(LaneTable::blue_slope, index)));
    RoughnessBounds bounds;
    bounds.product = Set(d, 0.1f) * (slope * color_slope);
    if (table.independent) bounds.product = zero;
    bounds.product = bounds.product * per_tolerance;
    bounds.shadow = slope * slope * Set(d, 0.03f * frame.largest_color) * per_tolerance;
    // What is dimmed already needs no care: behind 14 optical depths any of it is right.
    const VF seen = per_tolerance * (color_slope * progress.transmittance);
    VF extent, m, length;
    for (int halvings = 0;; ++halvings) {
      extent = end - v;
      const VF middle = c.at(MulAdd(half, extent, v));
      m = (middle + middle - (s + s_end)) * Set(d, 1 / 3.0f);
      length = IfThenElseZero(active, extent * piece.length);
      const VF cubed = p_3 * (extent * (extent * extent));
      // Between two places where the cubic does not turn, extinction is largest at one of them.
      bounds.extinction = Max(extinction_at(table, index, s), extinction_at(table, index, s_end));
      bounds.dimming = seen * (table.independent ? bounds.extinction : bounds.extinction * bounds.extinction);
      const MF rough = too_rough(length, m, cubed, s_end - s, bounds);
      if (AllFalse(d, rough)) break;
      if (HWY_UNLIKELY(halvings == most_halvings)) {
        // What is left is noted as it is seen.
        const VF error = roughness(length, m, cubed, s_end - s, bounds) * Set(d, frame.piece_tolerance);
        errors.left = MulAdd(IfThenElseZero(rough, Min(error, one)), progress.transmittance, errors.left);
        break;
      }
      end = IfThenElse(rough, MulAdd(half, extent, v), end);
      s_end = IfThenElse(rough, middle, s_end);
    }
    pieces += CountTrue(d, active);
    const auto add_step = [&](const CubicPlace& at) HWY_ATTR {
      add_step_error<closely>(IntervalLanes<Lookup>{table, index, interval, active, *frame.error_bound}, c, at,
                              piece.length, progress, sums);
    };
    if (HWY_UNLIKELY(round == 0 && has_steps)) add_step({v, s});
    const VF before = progress.transmittance;
    CL::lanes::add_piece<false>(table, index, s + m, s_end + m, s_end - s, length, progress);
    note_first_light(progress, MulAdd(v, piece.extent, piece.begin), notes);
    if (HWY_UNLIKELY(has_steps)) add_step({end, s_end});
    if (ramps != nullptr) {
      // Lanes that are done have an interval and no length.
      const VF ramp = GatherIndex(d, ramps, interval);
      if (!closely)
        errors.ramps = MulAdd(length * before, ramp, errors.ramps);
      else if (const MF steep = And(active, ramp > zero); !AllFalse(d, steep))
        add_ramp_excess(IntervalLanes<Lookup>{table, index, interval, steep, *frame.error_bound}, s_end, length, before,
                        progress, sums.excess);
    }
    v = IfThenElse(active, end, v);
    s = IfThenElse(active, s_end, s);
    active = And(active, v < one);
    if (AllFalse(d, active)) break;
  }
  // Rounds that do not do.
  errors.left = errors.left + IfThenElseZero(active, progress.transmittance);
  if (closely) set_close_errors(progress, *frame.error_bound, sums);
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
