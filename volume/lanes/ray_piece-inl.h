// SPDX-License-Identifier: BSD-3-Clause
// The light of one stretch of a ray inside one voxel, one per lane. Included once per instruction set (Highway's
// include guard idiom).
//
// What      The integral of light and optical depth over a stretch on which the field is the cubic of a trilinear
//           voxel.
// How       With v in [0, 1] over the stretch, the cubic is a straight line between its ends, s_0 + v (s_1 - s_0), plus
//           a deviation with the mean m = (2 s_mid - s_0 - s_1) / 3, which Simpson's rule gives exactly. The deviation
//           has an even part -4 b ((v - 1/2)^2 - 1/4) with b = 3 m / 2, and an odd part p_3 v (v - 1/2) (v - 1). Within
//           one interval of the transfer function, extinction and colour are linear in s. The line is shifted by m, so
//           that its optical depth is that of the cubic, and integrated exactly (integrals/integrate_lanes-inl.h). A
//           stretch that leaves its interval is divided where the cubic crosses the knot (ray_cubic-inl.h).
// Accuracy  The remaining deviation r has mean zero and is even or odd, so its products with constant terms, and those
//           of the even part with linear terms, vanish. The remaining errors per colour are
//             |k' c'| l (4 b^2 / 45 + |b p_3| / 20 + |p_3 (s_1 - s_0)| / 60)
//           from the product of extinction and colour, and
//             |k'|^2 c l^2 |r| (|s_1 - s_0| + |r|) / 30
//           because the deviation moves light and shadow inside the voxel. Both are below
//             l rho (rho + 0.3 |s_1 - s_0|) (0.1 |k' c'| + 0.03 |k'|^2 c l),  rho = |b| + |p_3| / 4.
//           The front attenuates the light of the back, so the deviation of the colour counts even if k is constant: T
//           falls by k l, and its products with the odd and the even part leave
//             |c'| (k l)^2 (|p_3| / 120 + k l |b| / 90).
//           Where the sum exceeds the tolerance the stretch is halved, which reduces the bound to an eighth or less.
// Ends      Stretches with NaN (blank) samples add nothing.

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

/// The error bounds of an interval of the transfer function. All but the extinction are divided by the tolerance.
struct RoughnessBounds {
  VF product, shadow, dimming, extinction;
};

/// Returns the error of a stretch relative to the tolerance; see Accuracy above.
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

/// Adds the stretches if they are smooth enough; otherwise adds nothing and returns false.
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

/// Returns the extinction at scalar s of an interval.
template <class Lookup>
HWY_INLINE VF extinction_at(const Lookup& table, typename Lookup::Index index, VF s) {
  const VF half = MulAdd(table.at(LaneTable::half_extinction_slope, index), s - table.at(LaneTable::base, index),
                         table.at(LaneTable::half_extinction, index));
  return half + half;
}

/// Upper bounds of the slopes of extinction and colour in each lane's interval.
struct FunctionSlopes {
  VF extinction, color;
};

template <class Lookup>
HWY_INLINE FunctionSlopes slopes_in(const Lookup& table, typename Lookup::Index index) {
  const auto slope = [&](int column) HWY_ATTR { return Abs(table.at(column, index)); };
  return {Set(DF(), 2.0f) * slope(LaneTable::half_extinction_slope),
          Max(Max(slope(LaneTable::red_slope), slope(LaneTable::green_slope)), slope(LaneTable::blue_slope))};
}

/// Largest number of times that a stretch is halved. With an optical depth of 1e4, the 4096 parts are still thin.
constexpr int most_halvings = 12;

/// Adds stretches that cross knots, are rough, or whose lanes are in different intervals. Returns a bound of their
/// errors; with `closely`, a closer bound, for which `progress` must be that of the stretch alone. Lanes with NaN
/// (blank) samples add nothing.
// Long: the values of a round stay in registers. With its steps as inlined functions a frame takes 11 % longer
// (AVX-512).
template <bool closely, class Lookup>
HWY_NOINLINE StretchErrors walk_cubic(const Lookup& table, const FrameView& frame, const Piece& piece,
                                      Progress& progress, RayNotes& notes, std::uint64_t& pieces) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f), half = Set(d, 0.5f);
  MF active = And(piece.length > zero, piece.s_mid == piece.s_mid);
  StretchErrors errors{zero, zero, zero};
  if (AllFalse(d, active)) return errors;
  [[maybe_unused]] Excess excess;
  if (closely) excess = {zero, zero, zero, zero, zero, zero, zero, zero};
  const Cubic c = cubic_of(piece, active);
  const Turns turns(c, active);
  const VF per_tolerance = Set(d, 1 / frame.piece_tolerance);
  const VF s_1 = IfThenElseZero(active, piece.s_1);
  const bool has_steps = frame.error_bound != nullptr && !frame.error_bound->step.empty();
  const float* const ramps =
      frame.error_bound != nullptr && !frame.error_bound->ramp.empty() ? frame.error_bound->ramp.data() : nullptr;
  VF v = zero, s = c.p_0;
  // Each round ends at a knot, an extremum, a halving or the end of the stretch; most functions have few knots per
  // stretch.
  for (int round = 0; round < 4096; ++round) {
    const VF turn = turns.after(v);
    const VF s_turn = IfThenElse(turn == one, s_1, c.at(turn));
    const MF up = s_turn >= s;
    const VI to_far_edge = IfThenElseZero(RebindMask(DI(), up), Set(DI(), 1));
    const VI interval = table.locate(s, up);
    const auto index = table.index(interval, active);
    const VF knot = table.edge(interval, index, to_far_edge);
    const MF crosses = And(active, Or(And(up, knot < s_turn), AndNot(up, knot > s_turn)));
    VF end = turn, s_end = s_turn;
    if (!AllFalse(d, crosses)) {
      end = IfThenElse(crosses, find_crossing(c, {v, s}, {turn, s_turn}, knot, crosses), end);
      s_end = IfThenElse(crosses, knot, s_end);
    }
    const FunctionSlopes slope = slopes_in(table, index);
    RoughnessBounds bounds;
    bounds.product = table.independent ? zero : Set(d, 0.1f) * (slope.extinction * slope.color) * per_tolerance;
    bounds.shadow = slope.extinction * slope.extinction * Set(d, 0.03f * frame.largest_color) * per_tolerance;
    // Attenuated colour needs less accuracy; behind an optical depth of 14, any value is accurate enough.
    const VF seen = per_tolerance * (slope.color * progress.transmittance);
    VF m, length;
    for (int halvings = 0;; ++halvings) {
      const VF extent = end - v, middle = MulAdd(half, extent, v), s_middle = c.at(middle);
      m = (s_middle + s_middle - (s + s_end)) * Set(d, 1 / 3.0f);
      length = IfThenElseZero(active, extent * piece.length);
      // Between two positions without an extremum in between, the extinction is largest at one of them.
      bounds.extinction = Max(extinction_at(table, index, s), extinction_at(table, index, s_end));
      bounds.dimming = seen * (table.independent ? bounds.extinction : bounds.extinction * bounds.extinction);
      const VF error = roughness(length, m, c.p_3 * (extent * (extent * extent)), s_end - s, bounds);
      const MF rough = error > one;
      if (AllFalse(d, rough)) break;
      if (HWY_UNLIKELY(halvings == most_halvings)) {
        // A part that is still not smooth counts as an error of the size of its visible light.
        const VF capped = Min(error * Set(d, frame.piece_tolerance), one);
        errors.left = MulAdd(IfThenElseZero(rough, capped), progress.transmittance, errors.left);
        break;
      }
      end = IfThenElse(rough, middle, end);
      s_end = IfThenElse(rough, s_middle, s_end);
    }
    pieces += CountTrue(d, active);
    const auto lanes_in = [&](MF lanes) HWY_ATTR {
      return IntervalLanes<Lookup>{table, index, interval, lanes, frame.error_bound};
    };
    const auto add_step = [&](const CubicPlace& at) HWY_ATTR {
      if constexpr (closely)
        add_step_error(lanes_in(active), c, at, piece.length, progress, excess);
      else
        add_step_error(lanes_in(active), c, at, piece.length, progress, errors);
    };
    if (HWY_UNLIKELY(round == 0 && has_steps)) add_step({v, s});
    const VF before = progress.transmittance;
    CL::lanes::add_piece<false>(table, index, {s + m, s_end + m, s_end - s, length}, progress);
    note_first_light(progress, MulAdd(v, piece.extent, piece.begin), notes);
    if (HWY_UNLIKELY(has_steps)) add_step({end, s_end});
    if (ramps != nullptr) {
      // Lanes that are finished still have an interval, but no length.
      const VF ramp = GatherIndex(d, ramps, interval);
      if (!closely) {
        errors.ramps = MulAdd(length * before, ramp, errors.ramps);
      } else if (const MF steep = And(active, ramp > zero); !AllFalse(d, steep)) {
        add_ramp_excess(lanes_in(steep), s_end, length, before, progress, excess);
      }
    }
    v = IfThenElse(active, end, v);
    s = IfThenElse(active, s_end, s);
    active = And(active, v < one);
    if (AllFalse(d, active)) break;
  }
  // The part that was not reached in 4096 rounds counts as an error.
  errors.left = errors.left + IfThenElseZero(active, progress.transmittance);
  if (closely) set_close_errors(excess, progress, *frame.error_bound, errors);
  return errors;
}

/// Adds stretches that cross knots, are rough, or whose lanes are in different intervals, and records their errors.
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
