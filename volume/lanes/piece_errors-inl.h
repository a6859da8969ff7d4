// SPDX-License-Identifier: BSD-3-Clause
// Errors of light in float lanes near steps and ramps of the transfer function (lane_error_bound.hpp), recorded along
// rays. Included once per instruction set (Highway's include guard idiom).
//
// What      For each stretch of a ray inside a voxel, a bound of the error of its light due to rounding of field and
//           positions.
// How       A ray is on the wrong side of a step for a length of noise / |slope| of the field, or of the square root of
//           2 noise / |second derivative| where the field is level (Touch). A ramp contributes for as long as the ray
//           is on it. Both are first bounded by the transmitted light. Where that bound is too large, Excess computes a
//           closer one by the inequality of Cauchy and Schwarz.
// Accuracy  tests/volume/steep_function_test.cpp compares the result with double precision.

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
#include "volume/lanes/ray_state-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

using integrals::LaneTable;

/// The transfer function where all lanes are in one interval.
struct UniformLookup {
  using Index = int;
  float row[LaneTable::column_count];
  bool independent, has_clear = false;
  float product_bound, shadow_bound;    ///< 0.1 |k' c'| and 0.03 |k'|^2 c, divided by the tolerance
  float ramp, ramp_steady, ramp_color;  ///< values of LaneErrorBound
  float dimming_bound, extinction;      ///< bounds of |c'| k^2 (independent: |c'| k) per tolerance, and of k
  HWY_INLINE VF at(int column, Index) const { return Set(DF(), row[column]); }
};

/// Reads a row of LaneErrorBound at the intervals or edges of the wanted lanes; returns zero in other lanes.
HWY_INLINE VF bound_row(const std::vector<float>& row, VI at, MF wanted) {
  const DF d;
  return IfThenElseZero(wanted, GatherIndex(d, row.data(), IfThenElseZero(RebindMask(DI(), wanted), at)));
}

/// The intervals of the transfer function that lanes are in, the wanted lanes, and the error bounds.
template <class Lookup>
struct IntervalLanes {
  const Lookup& table;
  typename Lookup::Index index;
  VI interval;
  MF wanted;
  const LaneErrorBound* bound;  ///< null: error bounds are not needed

  /// Reads a row of the bound at the intervals.
  HWY_INLINE VF row(const std::vector<float>& of) const { return bound_row(of, interval, wanted); }
};

/// Records the errors of a stretch due to the ramps of its intervals. If the stretch is opaque, the error of its colour
/// is visible only at its front.
template <class Lookup>
HWY_INLINE void note_ramps(const IntervalLanes<Lookup>& in, VF length, VF before, VF behind, RayNotes& notes) {
  if (in.bound->ramp.empty()) return;
  const DF d;
  const VF through = length * behind;
  const VF color = (before - behind) * in.row(in.bound->ramp_color);
  const VF ramp = through * in.row(in.bound->ramp), error = Max(ramp, color);
  notes.rough = MulAdd(error, error, notes.rough);
  notes.error_bound = MulAdd(ramp, Set(d, in.bound->steady), notes.error_bound);
}
HWY_INLINE void note_ramps(const UniformLookup& table, VF length, VF before, VF behind, RayNotes& notes) {
  const DF d;
  const VF through = length * behind;
  const VF color = (before - behind) * Set(d, table.ramp_color);
  const VF error = Max(through * Set(d, table.ramp), color);
  notes.rough = MulAdd(error, error, notes.rough);
  notes.error_bound = MulAdd(through, Set(d, table.ramp_steady), notes.error_bound);
}

/// A part of the cubic where the side of a step is uncertain: the length of this part, and the edges of the steps.
struct Touch {
  MF near;
  VI edge;
  VF length;
};

/// Finds lanes where `at` (an end of an interval, an extremum or a crossing) is near an edge of its interval. Its
/// position is uncertain by noise / |slope|; where the cubic is level, by the square root of 2 noise / |second
/// derivative|. `length` is that of the whole cubic. Returns false, and does not set `touch`, if no lane is near an
/// edge.
template <class Lookup>
HWY_INLINE bool touches(const IntervalLanes<Lookup>& in, const Cubic& c, const CubicPlace& at, VF length,
                        Touch& touch) {
  const DF d;
  const VF noise = Set(d, in.bound->noise);
  const VI below = Zero(DI()), above = Set(DI(), 1);
  const VF from_low = Abs(at.s - in.table.edge(in.interval, in.index, below)),
           from_high = Abs(in.table.edge(in.interval, in.index, above) - at.s);
  const MF to_high = from_high < from_low;
  const VF away = IfThenElse(to_high, from_high, from_low);
  touch.near = And(in.wanted, away < noise);
  if (HWY_LIKELY(AllFalse(d, touch.near))) return false;
  touch.edge = in.interval + IfThenElseZero(RebindMask(DI(), to_high), above);
  const VF bend = Abs(MulAdd(Set(d, 6.0f) * c.p_3, at.v, c.p_2 + c.p_2));
  const VF slope = Max(Abs(c.slope(at.v)), Sqrt((noise + noise) * bend));
  const VF share = Min(noise / Max(slope, Set(d, 1e-30f)), Set(d, 1.0f));
  touch.length = IfThenElseZero(touch.near, share * length);
  return true;
}

/// Error bounds of a stretch, as seen from the position where its light is measured.
struct StretchErrors {
  VF steps, ramps;
  VF left;  ///< error of pieces that could not be made small enough
};

/// Excess or missing optical depths w of media of colour c, at positions with transmittance T and light L in front of
/// them. With a = T c + L and E the light of the whole stretch, they change E by less than the sum of w |a - E|. By
/// Cauchy and Schwarz, that is less than the square root of (sum of w) (sum of w |a - E|^2).
struct Excess {
  VF depth, ramps, red, green, blue, square;  ///< sums of w, of w of ramps, of w a and of w |a|^2
  VF beside_steps, beside_ramps;  ///< differences of light at steps and ramps that do not depend on what is behind

  HWY_INLINE void add(VF w, VF through, const VF (&color)[3], const Progress& progress) {
    const VF a[3] = {MulAdd(through, color[0], progress.red), MulAdd(through, color[1], progress.green),
                     MulAdd(through, color[2], progress.blue)};
    depth = depth + w;
    red = MulAdd(w, a[0], red), green = MulAdd(w, a[1], green), blue = MulAdd(w, a[2], blue);
    square = MulAdd(w, MulAdd(a[0], a[0], MulAdd(a[1], a[1], a[2] * a[2])), square);
  }
  /// The error of the whole stretch due to the depths alone.
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

/// Adds a bound of the error of a step that the cubic touches or nearly touches at a position.
template <class Lookup>
HWY_NOINLINE void add_step_error(const IntervalLanes<Lookup>& in, const Cubic& c, const CubicPlace& at, VF length,
                                 const Progress& progress, StretchErrors& errors) {
  Touch touch;
  if (!touches(in, c, at, length, touch)) return;
  const VF weight = bound_row(in.bound->step, touch.edge, touch.near);
  const VF error = Min(touch.length * weight, Set(DF(), in.bound->most));
  errors.steps = MulAdd(error, progress.transmittance, errors.steps);
}
/// Adds a close bound of the same error.
template <class Lookup>
HWY_NOINLINE void add_step_error(const IntervalLanes<Lookup>& in, const Cubic& c, const CubicPlace& at, VF length,
                                 const Progress& progress, Excess& excess) {
  const DF d;
  Touch touch;
  if (!touches(in, c, at, length, touch)) return;
  const LaneErrorBound& bound = *in.bound;
  const auto row = [&](const std::vector<float>& of) HWY_ATTR { return bound_row(of, touch.edge, touch.near); };
  const VF most_depth = Set(d, 1e3f), behind = progress.transmittance;
  const VF length_there = IfThenElseZero(row(bound.step) > Zero(d), touch.length);
  const VF w = Min(length_there * row(bound.step_extinction), most_depth);
  const VF color[3] = {row(bound.step_red), row(bound.step_green), row(bound.step_blue)};
  excess.add(w, behind, color, progress);
  excess.beside_steps = MulAdd(length_there * row(bound.step_light), behind, excess.beside_steps);
}

/// Adds a close bound of the error of a piece of a ramp. The piece ends at scalar s_end, has the length `length`, and
/// the transmittance at its front is `before`.
template <class Lookup>
HWY_NOINLINE void add_ramp_excess(const IntervalLanes<Lookup>& steep, VF s_end, VF length, VF before,
                                  const Progress& progress, Excess& excess) {
  const DF d;
  const VF most_depth = Set(d, 1e3f), behind = progress.transmittance;
  const VF w = Min(length * steep.row(steep.bound->ramp_extinction), most_depth);
  VF color[3];
  colors_at(steep.table, steep.index, s_end, color);
  excess.add(w, behind, color, progress);
  excess.ramps = excess.ramps + w;
  const VF seen = steep.table.independent ? length * before : before - behind;
  excess.beside_ramps = MulAdd(seen, steep.row(steep.bound->ramp_color), excess.beside_ramps);
}

/// Distributes the error of depths in proportion to the depths; the additional differences of light are assigned
/// directly.
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
