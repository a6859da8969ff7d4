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
#include "volume/windows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

using CL::lanes::Progress;
using integrals::LaneTable;

/// One stretch a lane. The field at its ends and middle, the cubic's leading coefficient over it, and its length (zero:
/// nothing there). Where in the slab it begins, and how much of the slab it takes.
struct Piece {
  VF s_0, s_mid, s_1, p_3, length, begin, extent;
};

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

/// The bounds of an interval of the transfer function, already divided by the tolerance.
struct RoughnessBounds {
  VF product, shadow, dimming, extinction;
};

/// What a stretch errs, of the tolerance; see Error above.
HWY_INLINE VF roughness(VF length, VF m, VF p_3, VF span, const RoughnessBounds& bounds) {
  const DF d;
  const VF odd = HN::Abs(p_3), even = HN::Abs(m);
  const VF rho = HN::MulAdd(odd, HN::Set(d, 0.25f), HN::Mul(even, HN::Set(d, 1.5f)));
  const VF spread = HN::MulAdd(HN::Abs(span), HN::Set(d, 0.3f), rho);
  const VF scale = HN::MulAdd(length, bounds.shadow, bounds.product);
  const VF depth = HN::Mul(length, bounds.extinction);
  const VF dimmed = HN::MulAdd(odd, HN::Set(d, 1 / 120.0f), HN::Mul(HN::Mul(even, depth), HN::Set(d, 1 / 60.0f)));
  const VF error = HN::MulAdd(HN::Mul(rho, spread), scale, HN::Mul(HN::Mul(length, bounds.dimming), dimmed));
  return HN::Mul(length, error);
}

/// Whether a stretch errs more than the tolerance.
HWY_INLINE MF too_rough(VF length, VF m, VF p_3, VF span, const RoughnessBounds& bounds) {
  return HN::Gt(roughness(length, m, p_3, span, bounds), HN::Set(DF(), 1.0f));
}

/// Adds the stretches if they are smooth enough; false, and nothing added, if not.
template <bool cell_data>
HWY_INLINE bool add_uniform(const UniformLookup& table, const Piece& piece, Progress& progress) {
  const DF d;
  const VF span = HN::Sub(piece.s_1, piece.s_0);
  if (cell_data) {
    CL::lanes::add_piece<false>(table, 0, piece.s_0, piece.s_1, span, piece.length, progress);
    return true;
  }
  const VF m = HN::Mul(HN::Sub(HN::Add(piece.s_mid, piece.s_mid), HN::Add(piece.s_0, piece.s_1)), HN::Set(d, 1 / 3.0f));
  const MF rough = too_rough(piece.length, m, piece.p_3, span,
                             {HN::Set(d, table.product_bound), HN::Set(d, table.shadow_bound),
                              HN::Set(d, table.dimming_bound), HN::Set(d, table.extinction)});
  if (HWY_UNLIKELY(!HN::AllFalse(d, rough))) return false;
  CL::lanes::add_piece<false>(table, 0, HN::Add(piece.s_0, m), HN::Add(piece.s_1, m), span, piece.length, progress);
  return true;
}

/// A cubic over v in [0, 1].
struct Cubic {
  VF p_0, p_1, p_2, p_3;
  HWY_INLINE VF at(VF v) const { return HN::MulAdd(HN::MulAdd(HN::MulAdd(p_3, v, p_2), v, p_1), v, p_0); }
  HWY_INLINE VF slope(VF v) const {
    const DF d;
    return HN::MulAdd(HN::MulAdd(HN::Mul(HN::Set(d, 3.0f), p_3), v, HN::Add(p_2, p_2)), v, p_1);
  }
};

/// Places of the cubic's extrema in (0, 1), 1 where there are none.
HWY_INLINE void find_extrema(const Cubic& c, VF& first, VF& second) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f), three = HN::Set(d, 3.0f);
  const VF discriminant = HN::NegMulAdd(HN::Mul(three, c.p_1), c.p_3, HN::Mul(c.p_2, c.p_2));
  const VF root = HN::Sqrt(HN::Max(zero, discriminant));
  const VF q = HN::Neg(HN::Add(c.p_2, HN::CopySign(root, c.p_2)));
  const auto inside = [&](VF v) HWY_ATTR {
    const MF good = HN::And(HN::Gt(discriminant, zero), HN::And(HN::Gt(v, zero), HN::Lt(v, one)));
    return HN::IfThenElse(good, v, one);
  };
  const VF a = inside(HN::Div(q, HN::Mul(three, c.p_3))), b = inside(HN::Div(c.p_1, q));
  first = HN::Min(a, b);
  second = HN::Max(a, b);
}

/// v in [low, high] where the cubic, monotone there, has the value `level`, which lies between its ends'.
HWY_INLINE VF find_crossing(const Cubic& c, VF low, VF high, VF s_low, VF s_high, VF level, MF wanted) {
  const DF d;
  const VF half = HN::Set(d, 0.5f);
  const MF rises = HN::Gt(s_high, s_low);
  VF v = HN::MulAdd(HN::Sub(high, low), HN::Div(HN::Sub(level, s_low), HN::Sub(s_high, s_low)), low);
  for (int step = 0; step < 12; ++step) {
    const VF excess = HN::Sub(c.at(v), level);
    const MF above = HN::Gt(excess, HN::Zero(d));
    // What lies on the far side becomes the bracket's end.
    const MF beyond = HN::Xor(above, HN::Not(rises));
    high = HN::IfThenElse(beyond, v, high);
    low = HN::IfThenElse(beyond, low, v);
    VF next = HN::Sub(v, HN::Div(excess, c.slope(v)));
    const MF kept = HN::And(HN::Ge(next, low), HN::Le(next, high));
    next = HN::IfThenElse(kept, next, HN::Mul(half, HN::Add(low, high)));
    // Newton's method squares its error: after a step of 1e-3 what is left is about 1e-6.
    const VF step_done = HN::IfThenElse(kept, HN::Set(d, 1e-3f), HN::Set(d, 1e-6f));
    const MF moving = HN::And(wanted, HN::Gt(HN::Abs(HN::Sub(next, v)), step_done));
    v = next;
    if (HN::AllFalse(d, moving)) break;
  }
  return v;
}

/// At scalar s of an interval.
template <class Lookup>
HWY_INLINE VF extinction_at(const Lookup& table, typename Lookup::Index index, VF s) {
  const VF half = HN::MulAdd(table.at(LaneTable::half_extinction_slope, index),
                             HN::Sub(s, table.at(LaneTable::base, index)), table.at(LaneTable::half_extinction, index));
  return HN::Add(half, half);
}

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

/// The cubic through a piece's ends and middle; zero where lanes are not active.
HWY_INLINE Cubic cubic_of(const Piece& piece, MF active) {
  const DF d;
  const VF s_0 = HN::IfThenElseZero(active, piece.s_0), s_mid = HN::IfThenElseZero(active, piece.s_mid),
           s_1 = HN::IfThenElseZero(active, piece.s_1), p_3 = HN::IfThenElseZero(active, piece.p_3);
  Cubic c;
  c.p_0 = s_0;
  c.p_3 = p_3;
  const VF bend = HN::Sub(HN::Add(s_0, s_1), HN::Add(s_mid, s_mid));
  c.p_2 = HN::NegMulAdd(HN::Set(d, 1.5f), p_3, HN::Add(bend, bend));
  c.p_1 = HN::Sub(HN::Sub(HN::Sub(s_1, s_0), c.p_2), p_3);
  return c;
}

/// Whether a cubic does not turn in [0, 1] for certain: its slope's Bezier coefficients are of one sign.
HWY_INLINE MF is_monotone(const Cubic& c) {
  const DF d;
  const VF zero = HN::Zero(d);
  const VF d_1 = HN::Add(c.p_1, c.p_2), d_2 = HN::Add(d_1, HN::MulAdd(HN::Set(d, 3.0f), c.p_3, c.p_2));
  const VF least = HN::Min(c.p_1, HN::Min(d_1, d_2)), most = HN::Max(c.p_1, HN::Max(d_1, d_2));
  return HN::Not(HN::And(HN::Lt(least, zero), HN::Gt(most, zero)));
}

template <class Lookup>
HWY_INLINE VF color_slope_of(const Lookup& table, typename Lookup::Index index) {
  return HN::Max(
      HN::Max(HN::Abs(table.at(LaneTable::red_slope, index)), HN::Abs(table.at(LaneTable::green_slope, index))),
      HN::Abs(table.at(LaneTable::blue_slope, index)));
}

/// Bounds that hold in all of an interval; extinction and dimming are the caller's.
template <class Lookup>
HWY_INLINE RoughnessBounds bounds_of(const Lookup& table, typename Lookup::Index index, VF color_slope,
                                     float largest_color, VF per_tolerance) {
  const DF d;
  const VF slope = HN::Mul(HN::Set(d, 2.0f), HN::Abs(table.at(LaneTable::half_extinction_slope, index)));
  RoughnessBounds bounds;
  bounds.product = HN::Mul(HN::Set(d, 0.1f), HN::Mul(slope, color_slope));
  if (table.independent) bounds.product = HN::Zero(d);
  bounds.product = HN::Mul(bounds.product, per_tolerance);
  bounds.shadow = HN::Mul(HN::Mul(HN::Mul(slope, slope), HN::Set(d, 0.03f * largest_color)), per_tolerance);
  return bounds;
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

/// A stretch is halved no more often; 4096 of an optical depth of 1e4 are still thin.
constexpr int most_halvings = 12;

/// Stretches that cross knots, are rough, or whose lanes are in different intervals, and what they may err: a bound, or
/// `closely`, where `progress` is that of the stretch alone. NaN samples are blank.
template <bool closely, class Lookup>
HWY_NOINLINE StretchErrors walk_cubic(const Lookup& table, const FrameView& frame, const Piece& piece,
                                      Progress& progress, RayNotes& notes, std::uint64_t& pieces) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f), half = HN::Set(d, 0.5f);
  MF active = HN::And(HN::Gt(piece.length, zero), HN::Eq(piece.s_mid, piece.s_mid));
  StretchErrors errors{zero, zero, zero};
  Excess excess{zero, zero, zero, zero, zero, zero, zero, zero};
  if (HN::AllFalse(d, active)) return errors;
  const Cubic c = cubic_of(piece, active);
  const VF s_0 = c.p_0, s_1 = HN::IfThenElseZero(active, piece.s_1), p_3 = c.p_3;
  VF turn_1 = one, turn_2 = one;
  if (!HN::AllFalse(d, HN::AndNot(is_monotone(c), active))) find_extrema(c, turn_1, turn_2);

  const VF per_tolerance = HN::Set(d, 1 / frame.piece_tolerance);
  const bool has_steps = frame.error_bound != nullptr && !frame.error_bound->step.empty();
  const float* const ramps =
      frame.error_bound != nullptr && !frame.error_bound->ramp.empty() ? frame.error_bound->ramp.data() : nullptr;
  VF v = zero, s = s_0;
  // Each round ends at a knot, an extremum, a halving or the stretch's end; knots are few but for wild functions.
  for (int round = 0; round < 4096; ++round) {
    const VF turn = HN::IfThenElse(HN::Lt(v, turn_1), turn_1, HN::IfThenElse(HN::Lt(v, turn_2), turn_2, one));
    const VF s_turn = HN::IfThenElse(HN::Eq(turn, one), s_1, c.at(turn));
    const MF up = HN::Ge(s_turn, s);
    const VI to_far_edge = HN::IfThenElseZero(HN::RebindMask(DI(), up), HN::Set(DI(), 1));
    const VI interval = table.locate(s, up);
    const auto index = table.index(interval, active);
    const VF knot = table.edge(interval, index, to_far_edge);
    const MF crosses = HN::And(active, HN::Or(HN::And(up, HN::Lt(knot, s_turn)), HN::AndNot(up, HN::Gt(knot, s_turn))));
    VF end = turn, s_end = s_turn;
    if (!HN::AllFalse(d, crosses)) {
      const VF at_knot = find_crossing(c, v, turn, s, s_turn, knot, crosses);
      end = HN::IfThenElse(crosses, at_knot, end);
      s_end = HN::IfThenElse(crosses, knot, s_end);
    }
    const VF color_slope = color_slope_of(table, index);
    RoughnessBounds bounds = bounds_of(table, index, color_slope, frame.largest_color, per_tolerance);
    // What is dimmed already needs no care: behind 14 optical depths any of it is right.
    const VF seen = HN::Mul(per_tolerance, HN::Mul(color_slope, progress.transmittance));
    VF extent, m, length;
    for (int halvings = 0;; ++halvings) {
      extent = HN::Sub(end, v);
      const VF middle = c.at(HN::MulAdd(half, extent, v));
      m = HN::Mul(HN::Sub(HN::Add(middle, middle), HN::Add(s, s_end)), HN::Set(d, 1 / 3.0f));
      length = HN::IfThenElseZero(active, HN::Mul(extent, piece.length));
      const VF cubed = HN::Mul(p_3, HN::Mul(extent, HN::Mul(extent, extent)));
      // Between two places where the cubic does not turn, extinction is largest at one of them.
      bounds.extinction = HN::Max(extinction_at(table, index, s), extinction_at(table, index, s_end));
      bounds.dimming =
          HN::Mul(seen, table.independent ? bounds.extinction : HN::Mul(bounds.extinction, bounds.extinction));
      const MF rough = too_rough(length, m, cubed, HN::Sub(s_end, s), bounds);
      if (HN::AllFalse(d, rough)) break;
      if (HWY_UNLIKELY(halvings == most_halvings)) {
        // What is left is noted as it is seen.
        const VF error =
            HN::Mul(roughness(length, m, cubed, HN::Sub(s_end, s), bounds), HN::Set(d, frame.piece_tolerance));
        errors.left = HN::MulAdd(HN::IfThenElseZero(rough, HN::Min(error, one)), progress.transmittance, errors.left);
        break;
      }
      end = HN::IfThenElse(rough, HN::MulAdd(half, extent, v), end);
      s_end = HN::IfThenElse(rough, middle, s_end);
    }
    pieces += HN::CountTrue(d, active);
    if (HWY_UNLIKELY(round == 0 && has_steps))
      add_step_error<closely>(table, index, interval, active, *frame.error_bound, c, v, s, piece.length, progress,
                              errors, excess);
    const VF before = progress.transmittance;
    CL::lanes::add_piece<false>(table, index, HN::Add(s, m), HN::Add(s_end, m), HN::Sub(s_end, s), length, progress);
    note_first_light(progress, HN::MulAdd(v, piece.extent, piece.begin), notes);
    if (HWY_UNLIKELY(has_steps))
      add_step_error<closely>(table, index, interval, active, *frame.error_bound, c, end, s_end, piece.length, progress,
                              errors, excess);
    if (ramps != nullptr) {
      // Lanes that are done have an interval and no length.
      const VF ramp = HN::GatherIndex(d, ramps, interval);
      if (!closely)
        errors.ramps = HN::MulAdd(HN::Mul(length, before), ramp, errors.ramps);
      else if (const MF steep = HN::And(active, HN::Gt(ramp, zero)); !HN::AllFalse(d, steep))
        add_ramp_excess(table, index, interval, steep, *frame.error_bound, s_end, length, before, progress, excess);
    }
    v = HN::IfThenElse(active, end, v);
    s = HN::IfThenElse(active, s_end, s);
    active = HN::And(active, HN::Lt(v, one));
    if (HN::AllFalse(d, active)) break;
  }
  // Rounds that do not do.
  errors.left = HN::Add(errors.left, HN::IfThenElseZero(active, progress.transmittance));
  if (closely) set_close_errors(excess, progress, *frame.error_bound, errors);
  return errors;
}

/// Adds stretches that cross knots, are rough, or whose lanes are in different intervals, and notes what they may err.
template <class Lookup>
HWY_INLINE void add_any(const Lookup& table, const FrameView& frame, const Piece& piece, Progress& progress,
                        RayNotes& notes, std::uint64_t& pieces) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f), before = progress.transmittance;
  StretchErrors errors = walk_cubic<false>(table, frame, piece, progress, notes, pieces);
  if (HWY_LIKELY(frame.error_bound == nullptr)) return;
  const MF matters = HN::Gt(HN::Add(errors.steps, errors.ramps), HN::Set(d, frame.error_bound->matters));
  if (HWY_UNLIKELY(!HN::AllFalse(d, matters))) {
    Progress alone{zero, one, zero, zero, zero, zero};
    RayNotes none{zero, HN::Eq(zero, zero), zero, zero};
    std::uint64_t again = 0;
    const StretchErrors close = walk_cubic<true>(table, frame, piece, alone, none, again);
    const auto less = [&](VF far, VF near) HWY_ATTR { return HN::Min(far, HN::Mul(before, near)); };
    const VF ramps = less(errors.ramps, close.ramps);
    errors.steps = HN::Min(HN::Add(errors.steps, HN::Sub(errors.ramps, ramps)), HN::Mul(before, close.steps));
    errors.ramps = ramps;
  }
  const VF steady = HN::Set(d, frame.error_bound->steady);
  notes.error_bound = HN::Add(notes.error_bound, HN::Add(errors.left, HN::MulAdd(errors.ramps, steady, errors.steps)));
  notes.rough = HN::MulAdd(errors.ramps, errors.ramps, notes.rough);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
