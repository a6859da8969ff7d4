// SPDX-License-Identifier: BSD-3-Clause
// The exact integral of one ray segment a float lane, to be inlined in a loop over segments; included once per
// instruction set (Highway's include guard idiom).
//
// What      int kappa c T dt (or int c T dt, independent emission) and int kappa dt over a segment whose scalar is
// linear,
//           for a transfer function that is piecewise linear (LaneTable). A lane is cut where its scalar crosses a
//           knot, and pieces of more than one optical depth are cut again. A ray at a knot going up, or staying there,
//           is in the interval above, going down in the interval below.
// How       Over a piece kappa goes linearly from kappa_0 to kappa_1 and colour is c = start + slope * x, x linear too.
//           With a = kappa_0 l, e = kappa_1 l, the piece's optical depth is h = (a + e) / 2, and with b = (e - a) / 2
//           the depth up to u in [0, 1] is q(u) = h u - b u (1 - u). By parts, as in segment_integrator.hpp,
//             int kappa c T dt = start A + slope (x_0 A + (x_1 - x_0) P),  A = 1 - exp(-h),  P = M - exp(-h),
//             M = int_0^1 exp(-q) du = exp(-h/2) (1 + g),  1 + g = int_0^1 exp(b u (1 - u)) cosh(h (u - 1/2)) du.
//           All three colours share A and the bracket. g is even in h, so a short polynomial in b and h^2 gives it, and
//           with e_1 = 1 - exp(-h/2), also a polynomial, A = e_1 (2 - e_1) and P = exp(-h/2) (g + e_1) lose nothing
//           where h is 1e-9. No exponential is evaluated at all.
// Accuracy  tests/integrals/lane_integrator_test.cpp states and holds it.
// Bits      A lane's result depends on that lane alone: what only some lanes need is blended in by lane. Products and
//           sums are fused where MulAdd is written and nowhere else, so that every copy of this code rounds alike:
//           sources that include it are compiled with -ffp-contract=off.
// Ends      Where the optical depth passes 20, what lies behind is left out (2e-9 of the light); optical_depth then
//           counts the pieces so far and is at least 20.

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

/// Light that leaves a segment's front, linear RGB, what the segment hides of that behind it, and int kappa dt.
struct Light {
  VF alpha, optical_depth, red, green, blue;
};

namespace lanes {

constexpr float opaque_depth = 20.0f;  // exp(-20) = 2e-9
constexpr float most_depth = 1e15f;    // of a piece that is cut: squares of it stay finite
constexpr float most_length = 1e18f;   // times a table's largest number stays finite
constexpr float step_depth = 1.0f;     // the polynomials' bound
constexpr int pieces_a_fold = 16;

/// c[0] + c[1] x + ...
template <std::size_t count>
HWY_INLINE VF polynomial(VF x, const float (&c)[count]) {
  const DF d;
  VF sum = HN::Set(d, c[count - 1]);
  for (std::size_t i = count - 1; i-- > 0;) sum = HN::MulAdd(sum, x, HN::Set(d, c[i]));
  return sum;
}

/// A stretch without knots, of at most about one optical depth.
struct Stretch {
  VF depth_front, depth_back;  ///< half the extinction there times the stretch's length: a / 2 and e / 2 above
  VF from, span;               ///< scalar at its front relative to the interval's base, and the change to its back
  VF length;
};

/// What a stretch adds: light = start * weight + slope * moment.
struct StretchLight {
  VF alpha, weight, moment;
};

// Minimax fits over 0 <= h <= 1, |b| <= h: e_1 = h e(h) to 1.4e-9 of itself; g = b g_b(b) + h^2 g_bh2(b) + h^4 g_bh4(b)
// to 1.9e-7 h, 3e-8 h where h is small; o = o_b(b) + h^2 o_bh2(b) + h^4 o_h4 to 1.9e-7 / h.
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
  const VF half = HN::Set(d, 0.5f), one = HN::Set(d, 1.0f);
  const VF h = HN::Add(s.depth_front, s.depth_back), b = HN::Sub(s.depth_back, s.depth_front);
  const VF h2 = HN::Mul(h, h);
  const VF fade = HN::Mul(h, polynomial(h, e_1)), through_half = HN::Sub(one, fade);
  const VF g_h4 = polynomial(b, g_bh4), g_h2 = HN::MulAdd(h2, g_h4, polynomial(b, g_bh2));
  const VF g = HN::MulAdd(h2, g_h2, HN::Mul(b, polynomial(b, g_b)));
  StretchLight light;
  light.alpha = HN::Mul(fade, HN::Sub(HN::Set(d, 2.0f), fade));
  if (HWY_UNLIKELY(independent)) {
    // int c T dt = l (start M + slope (x_0 M + (x_1 - x_0) F)), F = int u exp(-q) du = exp(-h/2) ((1 + g) / 2 - h o).
    const VF mean = HN::MulAdd(through_half, g, through_half);
    const VF o = HN::MulAdd(h2, HN::MulAdd(h2, HN::Set(d, o_h4), polynomial(b, o_bh2)), polynomial(b, o_b));
    const VF first = HN::Mul(through_half, HN::MulAdd(half, g, HN::NegMulAdd(h, o, half)));
    light.weight = HN::Mul(s.length, mean);
    light.moment = HN::MulAdd(HN::Mul(s.length, s.span), first, HN::Mul(s.from, light.weight));
    return light;
  }
  const VF late = HN::Mul(through_half, HN::Add(g, fade));
  light.weight = light.alpha;
  light.moment = HN::MulAdd(s.span, late, HN::Mul(s.from, light.alpha));
  return light;
}

/// What a lane has gathered so far.
struct Progress {
  VF alpha, transmittance, optical_depth, red, green, blue;
};

/// A stretch, what was gathered before it, and the sums over its piece, already dimmed by what lies before them.
struct Passage {
  Stretch rest;
  VF alpha, transmittance, weight, moment;
};

HWY_INLINE void add_stretch(bool independent, Passage& p) {
  const StretchLight light = stretch_light(p.rest, independent);
  p.weight = HN::MulAdd(p.transmittance, light.weight, p.weight);
  p.moment = HN::MulAdd(p.transmittance, light.moment, p.moment);
  const VF hidden = HN::Mul(p.transmittance, light.alpha);
  p.alpha = HN::Add(p.alpha, hidden);
  p.transmittance = HN::Sub(p.transmittance, hidden);
}

/// Takes steps of one optical depth off the front of thick lanes until no more than one is left, or nothing that shows.
/// The other lanes stay as they are. By value: a reference would keep the caller's numbers in memory.
HWY_NOINLINE inline Passage take_thick_steps(MF thick, bool independent, Passage p) {
  const DF d;
  const VF one = HN::Set(d, 1.0f), zero = HN::Zero(d), bound = HN::Set(d, step_depth), most = HN::Set(d, most_depth);
  const VF transmittance_left = HN::Set(d, 2e-9f);
  const auto cut = [&](VF& x, VF rest) HWY_ATTR { x = HN::IfThenElse(thick, rest, x); };
  cut(p.rest.depth_front, HN::Min(p.rest.depth_front, most));
  cut(p.rest.depth_back, HN::Min(p.rest.depth_back, most));
  constexpr int most_steps = 64;  // each lets exp(-1) through at most, so that 21 leave nothing
  for (int n = 0; n < most_steps && !HN::AllFalse(d, thick); ++n) {
    // With depths halved q(u) = 2 a u + (e - a) u^2; the root u of q(u) = bound in the form without cancellation.
    Stretch& s = p.rest;
    const VF a = s.depth_front, rise = HN::Sub(s.depth_back, a);
    const VF root = HN::Sqrt(HN::Max(zero, HN::MulAdd(a, a, HN::Mul(bound, rise))));
    const VF u = HN::Min(one, HN::Div(bound, HN::Add(a, root)));
    const VF left = HN::Sub(one, u), depth_cut = HN::MulAdd(rise, u, a);
    Passage step = p;
    step.rest = {HN::Mul(a, u), HN::Mul(depth_cut, u), s.from, HN::Mul(s.span, u), HN::Mul(s.length, u)};
    add_stretch(independent, step);
    cut(p.alpha, step.alpha);
    cut(p.transmittance, step.transmittance);
    cut(p.weight, step.weight);
    cut(p.moment, step.moment);
    cut(s.depth_front, HN::Mul(depth_cut, left));
    cut(s.depth_back, HN::Mul(s.depth_back, left));
    cut(s.from, HN::Add(s.from, step.rest.span));
    cut(s.span, HN::Mul(s.span, left));
    cut(s.length, HN::Mul(s.length, left));
    // A lane that nothing shows through any more is done: an empty stretch adds nothing.
    const MF dark = HN::And(thick, HN::Lt(p.transmittance, transmittance_left));
    for (VF* x : {&s.depth_front, &s.depth_back, &s.length}) *x = HN::IfThenElse(dark, zero, *x);
    thick = HN::And(thick, HN::Gt(HN::Add(s.depth_front, s.depth_back), bound));
  }
  return p;
}

/// The light of one piece of each lane, from scalar to scalar + span == target, in the intervals of `index`. Lanes
/// whose length is zero add nothing. In the `first` piece nothing lies before it: the same numbers, without products by
/// one and sums with zero.
template <bool first, class Lookup>
HWY_INLINE void add_piece(const Lookup& table, const typename Lookup::Index& index, VF scalar, VF target, VF span,
                          VF length, Progress& so_far) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f);
  const VF start = table.at(LaneTable::half_extinction, index),
           slope = table.at(LaneTable::half_extinction_slope, index);
  const VF base = table.at(LaneTable::base, index);
  const VF from = HN::Sub(scalar, base), to = HN::Sub(target, base);
  const Stretch whole{HN::Mul(HN::MulAdd(slope, from, start), length), HN::Mul(HN::MulAdd(slope, to, start), length),
                      from, span, length};
  const VF depth = HN::Add(whole.depth_front, whole.depth_back);
  if (table.has_clear && HN::AllFalse(d, HN::Gt(depth, zero))) return;

  VF weight, moment;
  const MF thick = HN::Gt(depth, HN::Set(d, step_depth));
  if (HWY_UNLIKELY(!HN::AllFalse(d, thick))) {
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
      so_far.transmittance = HN::Sub(one, light.alpha);
    } else {
      weight = HN::Mul(so_far.transmittance, light.weight);
      moment = HN::Mul(so_far.transmittance, light.moment);
      const VF hidden = HN::Mul(so_far.transmittance, light.alpha);
      so_far.alpha = HN::Add(so_far.alpha, hidden);
      so_far.transmittance = HN::Sub(so_far.transmittance, hidden);
    }
  }
  so_far.optical_depth = first ? depth : HN::Add(so_far.optical_depth, depth);
  const auto add_color = [&](int c, VF& sum) HWY_ATTR {
    sum = first ? HN::Mul(table.at(c, index), weight) : HN::MulAdd(table.at(c, index), weight, sum);
    sum = HN::MulAdd(table.at(c + 1, index), moment, sum);
  };
  add_color(LaneTable::red, so_far.red);
  add_color(LaneTable::green, so_far.green);
  add_color(LaneTable::blue, so_far.blue);
}

/// A segment's way from one knot to the next.
struct Walk {
  MF active, up;
  VI interval;
  VF scalar, back, length_per_scalar;

  /// The knot ahead or the segment's end, whichever comes first.
  template <class Lookup>
  HWY_INLINE VF target(const Lookup& table, const typename Lookup::Index& index) const {
    const VF knot = table.edge(interval, index, up);
    return HN::IfThenElse(up, HN::Min(knot, back), HN::Max(knot, back));
  }

  /// The pieces behind the knot at `scalar`, at most `most` of them.
  template <class Lookup>
  HWY_INLINE void go_on(const Lookup& table, int most, Progress& so_far) {
    const DF d;
    const DI di;
    const VI step = HN::IfThenElse(HN::RebindMask(di, up), HN::Set(di, 1), HN::Set(di, -1));
    for (int pieces = 0; pieces < most; ++pieces) {
      interval = HN::Add(interval, HN::IfThenElseZero(HN::RebindMask(di, active), step));
      const auto index = table.index(interval, active);
      const VF end = target(table, index), span = HN::Sub(end, scalar);
      const VF length = HN::IfThenElseZero(active, HN::Mul(span, length_per_scalar));
      active = HN::And(active, HN::Ne(end, back));
      add_piece<false>(table, index, scalar, end, span, length, so_far);
      scalar = end;
      active = HN::And(active, HN::Lt(so_far.optical_depth, HN::Set(d, opaque_depth)));
      if (HN::AllFalse(d, active)) break;
    }
  }
};

/// The rest of a walk of more than pieces_a_fold pieces. Long sums in float drift: these are sums of short ones.
template <class Lookup>
HWY_NOINLINE Progress go_far(const Lookup& table, Walk walk, Progress so_far) {
  const DF d;
  const VF zero = HN::Zero(d);
  for (std::size_t pieces = 0; pieces <= table.most_pieces && !HN::AllFalse(d, walk.active); pieces += pieces_a_fold) {
    Progress since{zero, HN::Set(d, 1.0f), zero, zero, zero, zero};
    walk.go_on(table, pieces_a_fold, since);
    const VF t = so_far.transmittance;
    so_far = {HN::MulAdd(t, since.alpha, so_far.alpha),           HN::Mul(t, since.transmittance),
              HN::Add(so_far.optical_depth, since.optical_depth), HN::MulAdd(t, since.red, so_far.red),
              HN::MulAdd(t, since.green, so_far.green),           HN::MulAdd(t, since.blue, so_far.blue)};
    walk.active = HN::And(walk.active, HN::Lt(so_far.optical_depth, HN::Set(d, opaque_depth)));
  }
  return so_far;
}

}  // namespace lanes

/// integrate_lanes() for segments that lie in one interval and are at most step_depth thick, which most are: straight
/// on, the same bits. `interval`: table.locate(front, back >= front). `more`: the lanes with a length whose segment is
/// not so, and whose light is not the answer. Lanes without a length may hold any finite numbers, and get zeros.
template <bool independent, TableForm form>
HWY_INLINE Light integrate_simple(const Lookup<form>& table, VI interval, VF length, VF front, VF back, MF& more) {
  const DF d;
  const MF active = HN::Gt(length, HN::Zero(d)), up = HN::Ge(back, front);
  length = HN::Min(length, HN::Set(d, lanes::most_length));
  const auto index = table.index(interval, active);
  const VF knot = table.edge(interval, index, up);
  const VF end = HN::IfThenElse(up, HN::Min(knot, back), HN::Max(knot, back));
  const VF start = table.at(LaneTable::half_extinction, index),
           slope = table.at(LaneTable::half_extinction_slope, index);
  const VF base = table.at(LaneTable::base, index);
  const VF from = HN::Sub(front, base), to = HN::Sub(back, base);
  const lanes::Stretch whole{HN::Mul(HN::MulAdd(slope, from, start), length),
                             HN::Mul(HN::MulAdd(slope, to, start), length), from, HN::Sub(back, front), length};
  const VF depth = HN::Add(whole.depth_front, whole.depth_back);
  more = HN::And(active, HN::Or(HN::Ne(end, back), HN::Gt(depth, HN::Set(d, lanes::step_depth))));
  const lanes::StretchLight light = lanes::stretch_light(whole, independent);
  const auto color = [&](int c) HWY_ATTR {
    return HN::MulAdd(table.at(c + 1, index), light.moment, HN::Mul(table.at(c, index), light.weight));
  };
  return {light.alpha, depth, color(LaneTable::red), color(LaneTable::green), color(LaneTable::blue)};
}

/// The integral over one segment a lane. `length` in the table's unit, >= 0; `front` and `back` as lane_scalar() gives
/// scalars. Finite where `active`; lanes that are not active may hold anything and get zeros.
template <TableForm form>
HWY_INLINE Light integrate_lanes(const Lookup<form>& table, VF length, VF front, VF back, MF active) {
  const DF d;
  const VF zero = HN::Zero(d), one = HN::Set(d, 1.0f);
  active = HN::And(active, HN::Gt(length, zero));
  length = HN::IfThenElseZero(active, HN::Min(length, HN::Set(d, lanes::most_length)));
  front = HN::IfThenElseZero(active, front);
  back = HN::IfThenElseZero(active, back);
  lanes::Progress so_far{zero, one, zero, zero, zero, zero};

  lanes::Walk walk;
  walk.up = HN::Ge(back, front);
  walk.interval = table.locate(front, walk.up);
  walk.back = back;
  const auto index = table.index(walk.interval, active);
  const VF end = walk.target(table, index), span = HN::Sub(end, front);
  walk.active = HN::And(active, HN::Ne(end, back));
  // What a level segment's division gives is not used.
  walk.length_per_scalar = HN::Div(length, HN::Sub(back, front));
  const VF piece = HN::IfThenElse(walk.active, HN::Mul(span, walk.length_per_scalar), length);
  lanes::add_piece<true>(table, index, front, end, span, piece, so_far);
  if (!HN::AllFalse(d, walk.active)) {
    walk.scalar = end;
    walk.active = HN::And(walk.active, HN::Lt(so_far.optical_depth, HN::Set(d, lanes::opaque_depth)));
    walk.go_on(table, lanes::pieces_a_fold, so_far);
    if (HWY_UNLIKELY(!HN::AllFalse(d, walk.active))) so_far = lanes::go_far(table, walk, so_far);
  }
  return {so_far.alpha, so_far.optical_depth, so_far.red, so_far.green, so_far.blue};
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#endif
