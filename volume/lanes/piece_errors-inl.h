// SPDX-License-Identifier: BSD-3-Clause
// What rays note on their way beside their light: where it begins, and what float lanes may err in it by steps and
// ramps of the transfer function (lane_error_bound.hpp); included once per instruction set.

#if defined(TESSERA_VOLUME_PIECE_ERRORS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_PIECE_ERRORS_INL_H_
#undef TESSERA_VOLUME_PIECE_ERRORS_INL_H_
#else
#define TESSERA_VOLUME_PIECE_ERRORS_INL_H_
#endif

#include <hwy/highway.h>

#include <vector>

#include "volume/frame_view.hpp"
#include "volume/lanes/ray_cubic-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

using CL::lanes::Progress;
using integrals::LaneTable;

/// What is noted of each ray on its way.
struct RayNotes {
  VF first;        ///< where light begins, in slabs from the chunk's first
  MF seen;         ///< whether it has
  VF error_bound;  ///< errors that may be (lane_error_bound.hpp), as seen from the chunk's front
  VF rough;        ///< squares of those that roundings make, each its own
};

HWY_INLINE void note_first_light(const Progress& progress, VF place, RayNotes& notes) {
  const DF d;
  const MF now = HN::AndNot(notes.seen, HN::Gt(progress.alpha, HN::Zero(d)));
  notes.first = HN::IfThenElse(now, place, notes.first);
  notes.seen = HN::Or(notes.seen, now);
}

/// The transfer function where all lanes are in one interval.
struct UniformLookup {
  using Index = int;
  float row[LaneTable::column_count];
  bool independent, has_clear = false;
  float product_bound, shadow_bound;    ///< 0.1 |k' c'| and 0.03 |k'|^2 c
  float ramp, ramp_steady, ramp_color;  ///< LaneErrorBound's
  float dimming_bound, extinction;      ///< |c'| k^2 (independent emission: |c'| k) and k, at most in the interval
  HWY_INLINE VF at(int column, Index) const { return HN::Set(DF(), row[column]); }
};

/// A row of LaneErrorBound at intervals or edges of the lanes that are wanted; zero elsewhere.
HWY_INLINE VF bound_row(const std::vector<float>& row, VI at, MF wanted) {
  const DF d;
  return HN::IfThenElseZero(wanted,
                            HN::GatherIndex(d, row.data(), HN::IfThenElseZero(HN::RebindMask(DI(), wanted), at)));
}

/// Notes what a stretch errs by the ramps of its intervals. Of an opaque one the colour's error is seen at its front.
HWY_INLINE void note_ramps(VI interval, MF wanted, VF length, const LaneErrorBound& bound, VF before, VF behind,
                           RayNotes& notes) {
  if (bound.ramp.empty()) return;
  const DF d;
  const VF through = HN::Mul(length, behind);
  const VF color = HN::Mul(HN::Sub(before, behind), bound_row(bound.ramp_color, interval, wanted));
  const VF ramp = HN::Mul(through, bound_row(bound.ramp, interval, wanted)), error = HN::Max(ramp, color);
  notes.rough = HN::MulAdd(error, error, notes.rough);
  notes.error_bound = HN::MulAdd(ramp, HN::Set(d, bound.steady), notes.error_bound);
}
HWY_INLINE void note_ramps(const UniformLookup& table, VF length, VF before, VF behind, RayNotes& notes) {
  const DF d;
  const VF through = HN::Mul(length, behind);
  const VF color = HN::Mul(HN::Sub(before, behind), HN::Set(d, table.ramp_color));
  const VF error = HN::Max(HN::Mul(through, HN::Set(d, table.ramp)), color);
  notes.rough = HN::MulAdd(error, error, notes.rough);
  notes.error_bound = HN::MulAdd(through, HN::Set(d, table.ramp_steady), notes.error_bound);
}

/// Where lanes cannot tell on which side of a step the cubic is: for how long, and the steps' edges.
struct Touch {
  MF near;
  VI edge;
  VF length;
};

/// Near v: at `s`, the stretch's beginning, an end of an interval, a turn, or a crossing. Field and place are uncertain
/// by noise / |slope|, or where the cubic is level by the root of 2 noise / |its second derivative|. False if nowhere.
template <class Lookup>
HWY_INLINE bool touches(const Lookup& table, typename Lookup::Index index, VI interval, MF active,
                        const LaneErrorBound& bound, const Cubic& c, VF v, VF s, VF length, Touch& touch) {
  const DF d;
  const VF noise = HN::Set(d, bound.noise);
  const VI below = HN::Zero(DI()), above = HN::Set(DI(), 1);
  const VF from_low = HN::Abs(HN::Sub(s, table.edge(interval, index, below))),
           from_high = HN::Abs(HN::Sub(table.edge(interval, index, above), s));
  const MF to_high = HN::Lt(from_high, from_low);
  const VF away = HN::IfThenElse(to_high, from_high, from_low);
  touch.near = HN::And(active, HN::Lt(away, noise));
  if (HWY_LIKELY(HN::AllFalse(d, touch.near))) return false;
  touch.edge = HN::Add(interval, HN::IfThenElseZero(HN::RebindMask(DI(), to_high), above));
  const VF bend = HN::Abs(HN::MulAdd(HN::Mul(HN::Set(d, 6.0f), c.p_3), v, HN::Add(c.p_2, c.p_2)));
  const VF slope = HN::Max(HN::Abs(c.slope(v)), HN::Sqrt(HN::Mul(HN::Add(noise, noise), bend)));
  const VF share = HN::Min(HN::Div(noise, HN::Max(slope, HN::Set(d, 1e-30f))), HN::Set(d, 1.0f));
  touch.length = HN::IfThenElseZero(touch.near, HN::Mul(share, length));
  return true;
}

/// What a stretch may err, as seen from where its light is measured.
struct StretchErrors {
  VF steps, ramps;
  VF left;  ///< by pieces that were not made small enough
};

/// Optical depths w that are too much or too few at places to which T gets through, of a medium of colour c, where what
/// lies in front sends L: with a = T c + L and all the stretch's light E they change it by less than the sum of
/// w |a - E|, and that is less than the root of (sum of w) (sum of w |a - E|^2) by Cauchy and Schwarz.
struct Excess {
  VF depth, ramps, red, green, blue, square;  ///< sums of w, of those of ramps, of w a and of w |a|^2
  VF beside_steps, beside_ramps;              ///< light that differs whatever lies behind

  HWY_INLINE void add(VF w, VF through, const VF (&color)[3], const Progress& progress) {
    const VF a[3] = {HN::MulAdd(through, color[0], progress.red), HN::MulAdd(through, color[1], progress.green),
                     HN::MulAdd(through, color[2], progress.blue)};
    depth = HN::Add(depth, w);
    red = HN::MulAdd(w, a[0], red), green = HN::MulAdd(w, a[1], green), blue = HN::MulAdd(w, a[2], blue);
    square = HN::MulAdd(w, HN::MulAdd(a[0], a[0], HN::MulAdd(a[1], a[1], HN::Mul(a[2], a[2]))), square);
  }
  /// Of the whole stretch, by the depths alone.
  HWY_INLINE VF error(const Progress& e, const LaneErrorBound& bound) const {
    const DF d;
    const VF across = HN::MulAdd(red, e.red, HN::MulAdd(green, e.green, HN::Mul(blue, e.blue)));
    const VF light = HN::MulAdd(e.red, e.red, HN::MulAdd(e.green, e.green, HN::Mul(e.blue, e.blue)));
    const VF squares = HN::MulAdd(depth, light, HN::NegMulAdd(HN::Set(d, 2.0f), across, square));
    const VF inside = HN::Sqrt(HN::Mul(depth, HN::Max(HN::Zero(d), squares)));
    const VF behind = HN::Mul(HN::Mul(depth, e.transmittance), HN::Set(d, bound.brightest));
    return HN::Add(inside, behind);
  }
};

template <class Lookup>
HWY_INLINE void colors_at(const Lookup& table, typename Lookup::Index index, VF s, VF (&color)[3]) {
  const VF from = HN::Sub(s, table.at(LaneTable::base, index));
  for (int c = 0; c < 3; ++c)
    color[c] = table.independent ? HN::Zero(DF())
                                 : HN::MulAdd(table.at(LaneTable::red_slope + 2 * c, index), from,
                                              table.at(LaneTable::red + 2 * c, index));
}

/// Adds what a step may err that the cubic is at v on, or nearly.
template <bool closely, class Lookup>
HWY_NOINLINE void add_step_error(const Lookup& table, typename Lookup::Index index, VI interval, MF active,
                                 const LaneErrorBound& bound, const Cubic& c, VF v, VF s, VF stretch_length,
                                 const Progress& progress, StretchErrors& sum, Excess& excess) {
  const DF d;
  const VF most_depth = HN::Set(d, 1e3f), behind = progress.transmittance;
  Touch touch;
  if (!touches(table, index, interval, active, bound, c, v, s, stretch_length, touch)) return;
  const auto row = [&](const std::vector<float>& of) HWY_ATTR { return bound_row(of, touch.edge, touch.near); };
  const VF weight = row(bound.step);
  if (!closely) {
    const VF error = HN::Min(HN::Mul(touch.length, weight), HN::Set(d, bound.most));
    sum.steps = HN::MulAdd(error, behind, sum.steps);
  } else {
    const VF length_there = HN::IfThenElseZero(HN::Gt(weight, HN::Zero(d)), touch.length);
    const VF w = HN::Min(HN::Mul(length_there, row(bound.step_extinction)), most_depth);
    const VF color[3] = {row(bound.step_red), row(bound.step_green), row(bound.step_blue)};
    excess.add(w, behind, color, progress);
    excess.beside_steps = HN::MulAdd(HN::Mul(length_there, row(bound.step_light)), behind, excess.beside_steps);
  }
}

/// Adds what a piece of a ramp errs, closely: of `length`, to which `before` got through.
template <class Lookup>
HWY_NOINLINE void add_ramp_excess(const Lookup& table, typename Lookup::Index index, VI interval, MF steep,
                                  const LaneErrorBound& bound, VF s_end, VF length, VF before, const Progress& progress,
                                  Excess& excess) {
  const DF d;
  const VF most_depth = HN::Set(d, 1e3f), behind = progress.transmittance;
  const VF w = HN::Min(HN::Mul(length, bound_row(bound.ramp_extinction, interval, steep)), most_depth);
  VF color[3];
  colors_at(table, index, s_end, color);
  excess.add(w, behind, color, progress);
  excess.ramps = HN::Add(excess.ramps, w);
  const VF seen = table.independent ? HN::Mul(length, before) : HN::Sub(before, behind);
  excess.beside_ramps = HN::MulAdd(seen, bound_row(bound.ramp_color, interval, steep), excess.beside_ramps);
}

/// Depths that differ are told apart by how much; light beside them is each one's own.
HWY_INLINE void set_close_errors(const Excess& excess, const Progress& progress, const LaneErrorBound& bound,
                                 StretchErrors& errors) {
  const DF d;
  const VF error = excess.error(progress, bound), most_error = HN::Set(d, bound.most);
  const VF share = HN::Div(excess.ramps, HN::Max(excess.depth, HN::Set(d, 1e-30f)));
  const VF of_ramps = HN::Mul(error, share);
  errors.ramps = HN::Min(most_error, HN::Add(of_ramps, excess.beside_ramps));
  errors.steps = HN::Min(most_error, HN::Add(HN::Sub(error, of_ramps), excess.beside_steps));
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
