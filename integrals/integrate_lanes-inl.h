// SPDX-License-Identifier: BSD-3-Clause
// The exact integral over ray segments in float lanes, one segment per lane, to be inlined in a loop over segments.
// Included once per instruction set (Highway's include guard idiom).
//
// What      int kappa c T dt (or int c T dt, independent emission) and int kappa dt over a segment whose scalar is
//           linear, for a transfer function that is piecewise linear (LaneTable). A segment is cut where its scalar
//           crosses a knot, and pieces of more than one optical depth are cut again. A scalar equal to a knot belongs
//           to the interval above if the scalar increases or is constant along the ray, and to the interval below if it
//           decreases.
// How       Over a piece kappa changes linearly from kappa_0 to kappa_1, and colour is c = start + slope * x, with x
//           linear too. With a = kappa_0 l, e = kappa_1 l, the piece's optical depth is h = (a + e) / 2. The depth up
//           to u in [0, 1] is q(u) = h u - b u (1 - u) with b = (e - a) / 2. Integration by parts, as in
//           segment_integrator.hpp, gives
//             int kappa c T dt = start A + slope (x_0 A + (x_1 - x_0) P),  A = 1 - exp(-h),  P = M - exp(-h),
//             M = int_0^1 exp(-q) du = exp(-h/2) (1 + g),  1 + g = int_0^1 exp(b u (1 - u)) cosh(h (u - 1/2)) du.
//           All three colours share A and the bracket. g is even in h, so a short polynomial in b and h^2 approximates
//           it. With e_1 = 1 - exp(-h/2), also a polynomial, A = e_1 (2 - e_1) and P = exp(-h/2) (g + e_1) lose no
//           precision even where h is 1e-9. No exponential function is evaluated.
// Accuracy  tests/integrals/lane_integrator_test.cpp states and checks it.
// Bits      A lane's result depends on that lane alone: code that only some lanes need is blended in by lane. Products
//           and sums are fused only where MulAdd is written, so that every copy of this code rounds alike; sources that
//           include it are compiled with -ffp-contract=off.
// Ends      Where the optical depth exceeds 20, the rest of the segment is omitted (2e-9 of the light); optical_depth
//           is then the sum of the pieces so far, at least 20.

#if defined(TESSERA_INTEGRALS_INTEGRATE_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_INTEGRALS_INTEGRATE_LANES_INL_H_
#undef TESSERA_INTEGRALS_INTEGRATE_LANES_INL_H_
#else
#define TESSERA_INTEGRALS_INTEGRATE_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include "integrals/lane_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {

/// Light that leaves the front of a segment, linear RGB; its opacity; and its optical depth int kappa dt.
struct Light {
  VF alpha, optical_depth, red, green, blue;
};

namespace lanes {

constexpr float opaque_depth = 20.0f;  // exp(-20) = 2e-9
constexpr float most_depth = 1e15f;    // most optical depth of a piece that is cut: its squares remain finite
constexpr float most_length = 1e18f;   // most length: products with the largest number in a table remain finite
constexpr float step_depth = 1.0f;     // the range in which the polynomials are valid
constexpr int pieces_a_fold = 16;

/// Returns c[0] + c[1] x + ...
template <std::size_t count>
HWY_INLINE VF polynomial(VF x, const float (&c)[count]) {
  const DF d;
  VF sum = Set(d, c[count - 1]);
  for (std::size_t i = count - 1; i-- > 0;) sum = MulAdd(sum, x, Set(d, c[i]));
  return sum;
}

/// A stretch without knots, of at most about one optical depth.
struct Stretch {
  VF depth_front, depth_back;  ///< half the extinction at each end times the stretch's length: a / 2 and e / 2 above
  VF from, span;  ///< scalar at the front relative to the interval's base, and change of the scalar from front to back
  VF length;
};

/// The light of a stretch is start * weight + slope * moment.
struct StretchLight {
  VF alpha, weight, moment;
};

// Minimax fits over 0 <= h <= 1, |b| <= h, and their errors:
//   e_1 = h e(h)                                  1.4e-9 e_1
//   g = b g_b(b) + h^2 g_bh2(b) + h^4 g_bh4(b)    1.9e-7 h, and 3e-8 h where h is small
//   o = o_b(b) + h^2 o_bh2(b) + h^4 o_h4          1.9e-7 / h
constexpr float e_1[] = {0.499999999312f,   -0.124999951852f,   0.0208327801554f,
                         -0.0026018185097f, 0.000255856557986f, -1.7525919055e-5f};
constexpr float g_b[] = {0.166666680449f, 0.0166684718002f, 0.00119048719931f, 6.6856007248e-5f, 2.70946476007e-6f};
constexpr float g_bh2[] = {0.0416657135187f, 0.00416650894235f, 0.000289663022651f, 1.69362711045e-5f};
constexpr float g_bh4[] = {0.000524696885061f, 3.75043097578e-5f, 8.73138877496e-6f};
constexpr float o_b[] = {0.0833333531774f, 0.00833212200079f, 0.000595357896661f, 3.3527899865e-5f};
constexpr float o_bh2[] = {0.00208316965904f, 0.00015103357027f, 9.71280246795e-6f};
constexpr float o_h4 = 1.864437097e-5f;

HWY_INLINE StretchLight stretch_light(const Stretch& s, bool independent) {
  const DF d;
  const VF half = Set(d, 0.5f), one = Set(d, 1.0f);
  const VF h = s.depth_front + s.depth_back, b = s.depth_back - s.depth_front;
  const VF h2 = h * h;
  const VF fade = h * polynomial(h, e_1), through_half = one - fade;
  const VF g_h4 = polynomial(b, g_bh4), g_h2 = MulAdd(h2, g_h4, polynomial(b, g_bh2));
  const VF g = MulAdd(h2, g_h2, b * polynomial(b, g_b));
  StretchLight light;
  light.alpha = fade * (Set(d, 2.0f) - fade);
  if (HWY_UNLIKELY(independent)) {
    // int c T dt = l (start M + slope (x_0 M + (x_1 - x_0) F)), F = int u exp(-q) du = exp(-h/2) ((1 + g) / 2 - h o).
    const VF mean = MulAdd(through_half, g, through_half);
    const VF o = MulAdd(h2, MulAdd(h2, Set(d, o_h4), polynomial(b, o_bh2)), polynomial(b, o_b));
    const VF first = through_half * MulAdd(half, g, NegMulAdd(h, o, half));
    light.weight = s.length * mean;
    light.moment = MulAdd(s.length * s.span, first, s.from * light.weight);
    return light;
  }
  const VF late = through_half * (g + fade);
  light.weight = light.alpha;
  light.moment = MulAdd(s.span, late, s.from * light.alpha);
  return light;
}

/// What a lane has accumulated so far.
struct Progress {
  VF alpha, transmittance, optical_depth, red, green, blue;
};

/// The rest of a piece, the opacity and transmittance accumulated in front of this rest, and the sums over the piece so
/// far, attenuated by what is in front of them.
struct Passage {
  Stretch rest;
  VF alpha, transmittance, weight, moment;
};

HWY_INLINE void add_stretch(bool independent, Passage& p) {
  const StretchLight light = stretch_light(p.rest, independent);
  p.weight = MulAdd(p.transmittance, light.weight, p.weight);
  p.moment = MulAdd(p.transmittance, light.moment, p.moment);
  const VF hidden = p.transmittance * light.alpha;
  p.alpha = p.alpha + hidden;
  p.transmittance = p.transmittance - hidden;
}

/// Integrates steps of one optical depth from the front of thick lanes, until at most one optical depth is left or the
/// rest is invisible. Other lanes are not changed. `p` is passed by value, because a reference would keep the caller's
/// variables in memory.
HWY_NOINLINE inline Passage take_thick_steps(MF thick, bool independent, Passage p) {
  const DF d;
  const VF one = Set(d, 1.0f), zero = Zero(d), bound = Set(d, step_depth), most = Set(d, most_depth);
  const VF transmittance_left = Set(d, 2e-9f);
  const auto cut = [&](VF& x, VF rest) HWY_ATTR { x = IfThenElse(thick, rest, x); };
  cut(p.rest.depth_front, Min(p.rest.depth_front, most));
  cut(p.rest.depth_back, Min(p.rest.depth_back, most));
  constexpr int most_steps = 64;  // each step transmits at most exp(-1), so a negligible rest is left after 21 steps
  for (int n = 0; n < most_steps && !AllFalse(d, thick); ++n) {
    // With halved depths, q(u) = 2 a u + (e - a) u^2. u is the solution of q(u) = bound, in the form without
    // cancellation.
    Stretch& s = p.rest;
    const VF a = s.depth_front, rise = s.depth_back - a;
    const VF root = Sqrt(Max(zero, MulAdd(a, a, bound * rise)));
    const VF u = Min(one, bound / (a + root));
    const VF left = one - u, depth_cut = MulAdd(rise, u, a);
    Passage step = p;
    step.rest = {a * u, depth_cut * u, s.from, s.span * u, s.length * u};
    add_stretch(independent, step);
    cut(p.alpha, step.alpha);
    cut(p.transmittance, step.transmittance);
    cut(p.weight, step.weight);
    cut(p.moment, step.moment);
    cut(s.depth_front, depth_cut * left);
    cut(s.depth_back, s.depth_back * left);
    cut(s.from, s.from + step.rest.span);
    cut(s.span, s.span * left);
    cut(s.length, s.length * left);
    // A lane through which nothing is visible is finished: its stretch becomes empty, which adds nothing.
    const MF dark = And(thick, p.transmittance < transmittance_left);
    for (VF* x : {&s.depth_front, &s.depth_back, &s.length}) *x = IfThenElse(dark, zero, *x);
    thick = And(thick, s.depth_front + s.depth_back > bound);
  }
  return p;
}

/// A piece of a segment, over which the scalar changes linearly from `front` to `back` == front + span.
struct LinearPiece {
  VF front, back, span, length;
};

/// Adds the light of one piece of each lane, in the intervals of `index`. Lanes whose length is zero add nothing.
/// `first` states that there is nothing in front of the piece: results are the same, without products with one and sums
/// with zero.
template <bool first, class Lookup>
HWY_INLINE void add_piece(const Lookup& table, const typename Lookup::Index& index, const LinearPiece& piece,
                          Progress& so_far) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  const VF start = table.at(LaneTable::half_extinction, index),
           slope = table.at(LaneTable::half_extinction_slope, index);
  const VF base = table.at(LaneTable::base, index);
  const VF from = piece.front - base, to = piece.back - base;
  const Stretch whole{MulAdd(slope, from, start) * piece.length, MulAdd(slope, to, start) * piece.length, from,
                      piece.span, piece.length};
  const VF depth = whole.depth_front + whole.depth_back;
  if (table.has_clear && AllFalse(d, depth > zero)) return;

  VF weight, moment;
  const MF thick = depth > Set(d, step_depth);
  if (HWY_UNLIKELY(!AllFalse(d, thick))) {
    Passage passage{whole, zero, one, zero, zero};
    if (!first) passage.alpha = so_far.alpha, passage.transmittance = so_far.transmittance;
    passage = take_thick_steps(thick, table.independent, passage);
    add_stretch(table.independent, passage);
    so_far.alpha = passage.alpha, so_far.transmittance = passage.transmittance;
    weight = passage.weight, moment = passage.moment;
  } else {
    const StretchLight light = stretch_light(whole, table.independent);
    if (first) {
      weight = light.weight, moment = light.moment;
      so_far.alpha = light.alpha;
      so_far.transmittance = one - light.alpha;
    } else {
      weight = so_far.transmittance * light.weight;
      moment = so_far.transmittance * light.moment;
      const VF hidden = so_far.transmittance * light.alpha;
      so_far.alpha = so_far.alpha + hidden;
      so_far.transmittance = so_far.transmittance - hidden;
    }
  }
  so_far.optical_depth = first ? depth : so_far.optical_depth + depth;
  const auto add_color = [&](int c, VF& sum) HWY_ATTR {
    sum = first ? table.at(c, index) * weight : MulAdd(table.at(c, index), weight, sum);
    sum = MulAdd(table.at(c + 1, index), moment, sum);
  };
  add_color(LaneTable::red, so_far.red);
  add_color(LaneTable::green, so_far.green);
  add_color(LaneTable::blue, so_far.blue);
}

/// A segment's path from one knot to the next.
struct Walk {
  MF active, up;
  VI interval;
  VF scalar, back, length_per_scalar;

  /// Returns the position of the next knot or of the segment's end, whichever comes first.
  template <class Lookup>
  HWY_INLINE VF target(const Lookup& table, const typename Lookup::Index& index) const {
    const VF knot = table.edge(interval, index, up);
    return IfThenElse(up, Min(knot, back), Max(knot, back));
  }

  /// Integrates at most `most` pieces, beginning at the knot at `scalar`.
  template <class Lookup>
  HWY_INLINE void go_on(const Lookup& table, int most, Progress& so_far) {
    const DF d;
    const DI di;
    const VI step = IfThenElse(RebindMask(di, up), Set(di, 1), Set(di, -1));
    for (int pieces = 0; pieces < most; ++pieces) {
      interval = interval + IfThenElseZero(RebindMask(di, active), step);
      const auto index = table.index(interval, active);
      const VF end = target(table, index), span = end - scalar;
      const VF length = IfThenElseZero(active, span * length_per_scalar);
      active = And(active, end != back);
      add_piece<false>(table, index, {scalar, end, span, length}, so_far);
      scalar = end;
      active = And(active, so_far.optical_depth < Set(d, opaque_depth));
      if (AllFalse(d, active)) break;
    }
  }
};

/// Integrates the rest of a walk with more than pieces_a_fold pieces. Long float sums drift, so it adds partial sums of
/// few pieces.
template <class Lookup>
HWY_NOINLINE Progress go_far(const Lookup& table, Walk walk, Progress so_far) {
  const DF d;
  const VF zero = Zero(d);
  for (std::size_t pieces = 0; pieces <= table.most_pieces && !AllFalse(d, walk.active); pieces += pieces_a_fold) {
    Progress since{zero, Set(d, 1.0f), zero, zero, zero, zero};
    walk.go_on(table, pieces_a_fold, since);
    const VF t = so_far.transmittance;
    so_far = {MulAdd(t, since.alpha, so_far.alpha),       t * since.transmittance,
              so_far.optical_depth + since.optical_depth, MulAdd(t, since.red, so_far.red),
              MulAdd(t, since.green, so_far.green),       MulAdd(t, since.blue, so_far.blue)};
    walk.active = And(walk.active, so_far.optical_depth < Set(d, opaque_depth));
  }
  return so_far;
}

}  // namespace lanes

/// integrate_lanes() in straight-line code, for the most frequent segments: those in one interval that are at most
/// step_depth thick. The bits are the same. `interval` must be table.locate(front, back >= front). `more` is set to the
/// lanes of nonzero length whose segment does not meet these conditions; their result is invalid. Lanes of zero length
/// may contain any finite numbers; their result is zero.
template <bool independent, TableForm form>
HWY_INLINE Light integrate_simple(const Lookup<form>& table, VI interval, VF length, VF front, VF back, MF& more) {
  const DF d;
  const MF active = length > Zero(d), up = back >= front;
  length = Min(length, Set(d, lanes::most_length));
  const auto index = table.index(interval, active);
  const VF knot = table.edge(interval, index, up);
  const VF end = IfThenElse(up, Min(knot, back), Max(knot, back));
  const VF start = table.at(LaneTable::half_extinction, index),
           slope = table.at(LaneTable::half_extinction_slope, index);
  const VF base = table.at(LaneTable::base, index);
  const VF from = front - base, to = back - base;
  const lanes::Stretch whole{MulAdd(slope, from, start) * length, MulAdd(slope, to, start) * length, from, back - front,
                             length};
  const VF depth = whole.depth_front + whole.depth_back;
  more = And(active, Or(end != back, depth > Set(d, lanes::step_depth)));
  const lanes::StretchLight light = lanes::stretch_light(whole, independent);
  const auto color = [&](int c) HWY_ATTR {
    return MulAdd(table.at(c + 1, index), light.moment, table.at(c, index) * light.weight);
  };
  return {light.alpha, depth, color(LaneTable::red), color(LaneTable::green), color(LaneTable::blue)};
}

/// Integrates one segment per lane. `length` is in the table's unit, >= 0; `front` and `back` are results of
/// lane_scalar(). All must be finite where `active`; other lanes may contain any numbers, and their result is zero.
template <TableForm form>
HWY_INLINE Light integrate_lanes(const Lookup<form>& table, VF length, VF front, VF back, MF active) {
  const DF d;
  const VF zero = Zero(d), one = Set(d, 1.0f);
  active = And(active, length > zero);
  length = IfThenElseZero(active, Min(length, Set(d, lanes::most_length)));
  front = IfThenElseZero(active, front);
  back = IfThenElseZero(active, back);
  lanes::Progress so_far{zero, one, zero, zero, zero, zero};

  lanes::Walk walk;
  walk.up = back >= front;
  walk.interval = table.locate(front, walk.up);
  walk.back = back;
  const auto index = table.index(walk.interval, active);
  const VF end = walk.target(table, index), span = end - front;
  walk.active = And(active, end != back);
  // For constant scalars the result of this division is not used.
  walk.length_per_scalar = length / (back - front);
  const VF piece = IfThenElse(walk.active, span * walk.length_per_scalar, length);
  lanes::add_piece<true>(table, index, {front, end, span, piece}, so_far);
  if (!AllFalse(d, walk.active)) {
    walk.scalar = end;
    walk.active = And(walk.active, so_far.optical_depth < Set(d, lanes::opaque_depth));
    walk.go_on(table, lanes::pieces_a_fold, so_far);
    if (HWY_UNLIKELY(!AllFalse(d, walk.active))) so_far = lanes::go_far(table, walk, so_far);
  }
  return {so_far.alpha, so_far.optical_depth, so_far.red, so_far.green, so_far.blue};
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#endif
