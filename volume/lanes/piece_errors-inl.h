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
  const MF now = AndNot(notes.seen, progress.alpha > Zero(d));
  notes.first = IfThenElse(now, place, notes.first);
  notes.seen = Or(notes.seen, now);
}

/// The transfer function where all lanes are in one interval.
struct UniformLookup {
  using Index = int;
  float row[LaneTable::column_count];
  bool independent, has_clear = false;
  float product_bound, shadow_bound;    ///< 0.1 |k' c'| and 0.03 |k'|^2 c
  float ramp, ramp_steady, ramp_color;  ///< LaneErrorBound's
  float dimming_bound, extinction;      ///< |c'| k^2 (independent emission: |c'| k) and k, at most in the interval
  HWY_INLINE VF at(int column, Index) const { return Set(DF(), row[column]); }
};

/// A row of LaneErrorBound at intervals or edges of the lanes that are wanted; zero elsewhere.
HWY_INLINE VF bound_row(const std::vector<float>& row, VI at, MF wanted) {
  const DF d;
  return IfThenElseZero(wanted, GatherIndex(d, row.data(), IfThenElseZero(RebindMask(DI(), wanted), at)));
}

/// Notes what a stretch errs by the ramps of its intervals. Of an opaque one the colour's error is seen at its front.
HWY_INLINE void note_ramps(VI interval, MF wanted, VF length, const LaneErrorBound& bound, VF before, VF behind,
                           RayNotes& notes) {
  if (bound.ramp.empty()) return;
  const DF d;
  const VF through = length * behind;
  const VF color = (before - behind) * bound_row(bound.ramp_color, interval, wanted);
  const VF ramp = through * bound_row(bound.ramp, interval, wanted), error = Max(ramp, color);
  notes.rough = MulAdd(error, error, notes.rough);
  notes.error_bound = MulAdd(ramp, Set(d, bound.steady), notes.error_bound);
}
HWY_INLINE void note_ramps(const UniformLookup& table, VF length, VF before, VF behind, RayNotes& notes) {
  const DF d;
  const VF through = length * behind;
  const VF color = (before - behind) * Set(d, table.ramp_color);
  const VF error = Max(through * Set(d, table.ramp), color);
  notes.rough = MulAdd(error, error, notes.rough);
  notes.error_bound = MulAdd(through, Set(d, table.ramp_steady), notes.error_bound);
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
  const VF noise = Set(d, bound.noise);
  const VI below = Zero(DI()), above = Set(DI(), 1);
  const VF from_low = Abs(s - table.edge(interval, index, below)),
           from_high = Abs(table.edge(interval, index, above) - s);
  const MF to_high = from_high < from_low;
  const VF away = IfThenElse(to_high, from_high, from_low);
  touch.near = And(active, away < noise);
  if (HWY_LIKELY(AllFalse(d, touch.near))) return false;
  touch.edge = interval + IfThenElseZero(RebindMask(DI(), to_high), above);
  const VF bend = Abs(MulAdd(Set(d, 6.0f) * c.p_3, v, c.p_2 + c.p_2));
  const VF slope = Max(Abs(c.slope(v)), Sqrt((noise + noise) * bend));
  const VF share = Min(noise / Max(slope, Set(d, 1e-30f)), Set(d, 1.0f));
  touch.length = IfThenElseZero(touch.near, share * length);
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
    const VF a[3] = {MulAdd(through, color[0], progress.red), MulAdd(through, color[1], progress.green),
                     MulAdd(through, color[2], progress.blue)};
    depth = depth + w;
    red = MulAdd(w, a[0], red), green = MulAdd(w, a[1], green), blue = MulAdd(w, a[2], blue);
    square = MulAdd(w, MulAdd(a[0], a[0], MulAdd(a[1], a[1], a[2] * a[2])), square);
  }
  /// Of the whole stretch, by the depths alone.
  HWY_INLINE VF error(const Progress& e, const LaneErrorBound& bound) const {
    const DF d;
    const VF across = MulAdd(red, e.red, MulAdd(green, e.green, blue * e.blue));
    const VF light = MulAdd(e.red, e.red, MulAdd(e.green, e.green, e.blue * e.blue));
    const VF squares = MulAdd(depth, light, NegMulAdd(Set(d, 2.0f), across, square));
    const VF inside = Sqrt(depth * Max(Zero(d), squares));
    const VF behind = depth * e.transmittance * Set(d, bound.brightest);
    return inside + behind;
  }
};

template <class Lookup>
HWY_INLINE void colors_at(const Lookup& table, typename Lookup::Index index, VF s, VF (&color)[3]) {
  const VF from = s - table.at(LaneTable::base, index);
  for (int c = 0; c < 3; ++c)
    color[c] = table.independent ? Zero(DF())
                                 : MulAdd(table.at(LaneTable::red_slope + 2 * c, index), from,
                                          table.at(LaneTable::red + 2 * c, index));
}

/// Adds what a step may err that the cubic is at v on, or nearly.
template <bool closely, class Lookup>
HWY_NOINLINE void add_step_error(const Lookup& table, typename Lookup::Index index, VI interval, MF active,
                                 const LaneErrorBound& bound, const Cubic& c, VF v, VF s, VF stretch_length,
                                 const Progress& progress, StretchErrors& sum, Excess& excess) {
  const DF d;
  const VF most_depth = Set(d, 1e3f), behind = progress.transmittance;
  Touch touch;
  if (!touches(table, index, interval, active, bound, c, v, s, stretch_length, touch)) return;
  const auto row = [&](const std::vector<float>& of) HWY_ATTR { return bound_row(of, touch.edge, touch.near); };
  const VF weight = row(bound.step);
  if (!closely) {
    const VF error = Min(touch.length * weight, Set(d, bound.most));
    sum.steps = MulAdd(error, behind, sum.steps);
  } else {
    const VF length_there = IfThenElseZero(weight > Zero(d), touch.length);
    const VF w = Min(length_there * row(bound.step_extinction), most_depth);
    const VF color[3] = {row(bound.step_red), row(bound.step_green), row(bound.step_blue)};
    excess.add(w, behind, color, progress);
    excess.beside_steps = MulAdd(length_there * row(bound.step_light), behind, excess.beside_steps);
  }
}

/// Adds what a piece of a ramp errs, closely: of `length`, to which `before` got through.
template <class Lookup>
HWY_NOINLINE void add_ramp_excess(const Lookup& table, typename Lookup::Index index, VI interval, MF steep,
                                  const LaneErrorBound& bound, VF s_end, VF length, VF before, const Progress& progress,
                                  Excess& excess) {
  const DF d;
  const VF most_depth = Set(d, 1e3f), behind = progress.transmittance;
  const VF w = Min(length * bound_row(bound.ramp_extinction, interval, steep), most_depth);
  VF color[3];
  colors_at(table, index, s_end, color);
  excess.add(w, behind, color, progress);
  excess.ramps = excess.ramps + w;
  const VF seen = table.independent ? length * before : before - behind;
  excess.beside_ramps = MulAdd(seen, bound_row(bound.ramp_color, interval, steep), excess.beside_ramps);
}

/// Depths that differ are told apart by how much; light beside them is each one's own.
HWY_INLINE void set_close_errors(const Excess& excess, const Progress& progress, const LaneErrorBound& bound,
                                 StretchErrors& errors) {
  const DF d;
  const VF error = excess.error(progress, bound), most_error = Set(d, bound.most);
  const VF share = excess.ramps / Max(excess.depth, Set(d, 1e-30f));
  const VF of_ramps = error * share;
  errors.ramps = Min(most_error, of_ramps + excess.beside_ramps);
  errors.steps = Min(most_error, error - of_ramps + excess.beside_steps);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
