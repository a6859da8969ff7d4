// SPDX-License-Identifier: BSD-3-Clause
// The field along a packet's rays in slabs that they cross from plane to plane; included once per instruction set.
//
// Way       Axes i and j are mirrored, lane by lane, where a ray moves down, so that all slopes are positive. p is the
//           axis whose plane a ray crosses first in the slab (at u_1), q the other (at u_2; 1: not crossed). A lane
//           meets at most eight lattice points a slice, numbered by their places along p and q from the voxel it
//           enters: 00 10 01 11 there, 20 21 behind p's plane, 12 22 behind q's.
// Field     Inside a voxel it is a cubic of u; half its second derivative in the middle of a stretch, tau, times
//           e^2 / 6 is what the stretch's mean lies below the middle of its ends (Simpson's rule, which cubics obey
//           exactly), e being the stretch's share of the slab. So the slab's mean follows from its values at planes and
//           crossings and three taus. tau = b_p b_q D_pq + b_p D_pk + b_q D_qk, products of differences and slopes.
// Line      The field is the line between the slab's ends and a rest: at the crossings d_1 and d_2, and between them
//           the cubics' bumps, at most e^2 |tau| / 4 of the even part and e^3 b_p b_q |D_pqk| / 4 of the odd (Bezier).

#if defined(TESSERA_VOLUME_SLAB_LINES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_VOLUME_SLAB_LINES_INL_H_
#undef TESSERA_VOLUME_SLAB_LINES_INL_H_
#else
#define TESSERA_VOLUME_SLAB_LINES_INL_H_
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "volume/lanes/packet_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::volume {
namespace HWY_NAMESPACE {

/// A packet's lanes in mirrored axes; see Way above.
struct MirroredLanes {
  VF x, y, bx, by, per_bx, per_by;      ///< slopes not negative, their inverses finite
  VF i_least, i_most, j_least, j_most;  ///< voxels of the volume
  VF sign_i, sign_j;                    ///< +1, or -1 where mirrored
  VF i, j;                              ///< lattice point 0 of the axes, relative to (i_base, j_base)
  VI step_i, step_j;                    ///< elements of the window from a lattice point to the next
  MF live;
  VF bends;

  /// `columns` of the window.
  HWY_INLINE MirroredLanes(const Lanes& lanes, int columns) {
    const DF d;
    const DI di;
    const VF zero = Zero(d), one = Set(d, 1.0f);
    const auto axis = [&](VF position, VF slope, VF least, VF most, VF& x_out, VF& b_out, VF& per, VF& sign,
                          VF& least_out, VF& most_out) HWY_ATTR {
      const MF down = slope < zero;
      sign = IfThenElse(down, Neg(one), one);
      x_out = sign * position;
      b_out = Abs(slope);
      per = one / Max(b_out, Set(d, 1e-30f));
      least_out = IfThenElse(down, Neg(most) - one, least);
      most_out = IfThenElse(down, Neg(least) - one, most);
    };
    axis(lanes.x, lanes.bx, lanes.i_least, lanes.i_most, x, bx, per_bx, sign_i, i_least, i_most);
    axis(lanes.y, lanes.by, lanes.j_least, lanes.j_most, y, by, per_by, sign_j, j_least, j_most);
    i = lanes.i, j = lanes.j;
    step_i = ConvertTo(di, sign_i);
    step_j = ConvertTo(di, Set(d, static_cast<float>(columns)) * sign_j);
    bends = bx * by;
    live = lanes.k_in < lanes.k_out;
  }
};

/// What is found of up to eight slabs; s[n] at slab n's front plane.
struct SlabLines {
  static constexpr int most = 8;
  int first;  ///< slab of place 0
  VF s[most + 1];
  VF u_1[most], u_2[most], f_1[most], f_2[most];  ///< crossings and the field there
  VF sag[most];                                   ///< sum of e^3 tau / 6
  VF bump[most];
  VF even[3][most], odd[3][most];  ///< of each stretch: e^2 tau, and the cubic's coefficient over it
};

/// A slab as one line: the mean is shift above the middle of its ends, the field within rho of the line. Not a number
/// where the field is not.
struct Line {
  VF s_0, s_1, span, shift, rho;
};

HWY_INLINE Line line_of(const SlabLines& lines, int n) {
  const DF d;
  const VF one = Set(d, 1.0f), half = Set(d, 0.5f);
  Line line;
  line.s_0 = lines.s[n], line.s_1 = lines.s[n + 1];
  line.span = line.s_1 - line.s_0;
  const VF u_1 = lines.u_1[n], u_2 = lines.u_2[n];
  const VF d_1 = IfThenElseZero(u_1 < one, lines.f_1[n] - MulAdd(u_1, line.span, line.s_0)),
           d_2 = IfThenElseZero(u_2 < one, lines.f_2[n] - MulAdd(u_2, line.span, line.s_0));
  // Trapezia: the ends' weights are half the stretches beside them.
  const VF kinks = MulAdd(d_1, u_2, d_2 * (one - u_1));
  line.shift = NegMulAdd(Set(d, 1.0f), lines.sag[n], half * kinks);
  line.rho = Max(Abs(d_1), Abs(d_2)) + lines.bump[n];
  return line;
}

/// How a slab's field goes along with itself and with the way, but for the odd parts of its cubics: with r the rest
/// above the line (kinks and the cubics' even parts), m its mean, and u from 0 to 1,
///   product     of two functions linear in the field: the integral of the field's square less that of (line + m)'s,
///   covariance  of r and u;  odd  bound of what is left out.
struct Bend {
  VF product, covariance, odd;
};

HWY_INLINE Bend bend_of(const SlabLines& lines, int n, const Line& line) {
  const DF d;
  const auto number = [](double v) HWY_ATTR { return Set(DF(), static_cast<float>(v)); };
  const VF zero = Zero(d), one = number(1), half = number(0.5);
  const VF u[4] = {zero, lines.u_1[n], lines.u_2[n], one};
  const auto kink = [&](VF at, VF f) HWY_ATTR { return IfThenElseZero(at < one, f - MulAdd(at, line.span, line.s_0)); };
  const VF r[4] = {zero, kink(u[1], lines.f_1[n]), kink(u[2], lines.f_2[n]), zero};
  VF mean = zero, square = zero, moment = zero, odd = zero;
  for (int k = 0; k < 3; ++k) {
    // A chord from p to q and a parabola on it, of height b.
    const VF p = r[k], q = r[k + 1], b = number(-0.25) * lines.even[k][n];
    const VF e = u[k + 1] - u[k], middle = half * (u[k] + u[k + 1]), sum = p + q;
    const VF area = MulAdd(half, sum, number(2 / 3.0) * b);
    mean = MulAdd(e, area, mean);
    const VF chords = MulAdd(sum, sum, Neg(p * q));
    square = MulAdd(e, MulAdd(number(1 / 3.0), chords, b * MulAdd(number(2 / 3.0), sum, number(8 / 15.0) * b)), square);
    moment = MulAdd(e, MulAdd(middle, area, number(1 / 12.0) * e * (q - p)), moment);
    odd = Max(odd, Abs(lines.odd[k][n]));
  }
  Bend bend;
  bend.covariance = NegMulAdd(half, mean, moment);
  bend.product = MulAdd(line.span + line.span, bend.covariance, Max(zero, NegMulAdd(mean, mean, square)));
  bend.odd = number(0.0482) * odd;  // v (v - 1/2) (v - 1) is at most 1 / (12 sqrt 3)
  return bend;
}

/// Where a slab's window begins, and whether all voxels that may be met have neighbours in the volume.
struct WindowPlace {
  const float *front, *back;
  float origin;          ///< element of voxel (i_base, j_base), negative
  std::ptrdiff_t pitch;  ///< elements of a slice between rows
  bool inner;
};

/// The voxels that lanes are in at plane n of the chunk, and where in them.
struct VoxelAt {
  VF i, j;    ///< mirrored axes
  VF fx, fy;  ///< from its corner, 0 to 1

  HWY_INLINE VoxelAt(const MirroredLanes& lanes, const WindowPlace& place, int n) {
    const VF k = Set(DF(), static_cast<float>(n));
    const VF x = MulAdd(k, lanes.bx, lanes.x), y = MulAdd(k, lanes.by, lanes.y);
    i = Floor(x), j = Floor(y);
    if (HWY_UNLIKELY(!place.inner)) {
      i = Min(Max(i, lanes.i_least), lanes.i_most);
      j = Min(Max(j, lanes.j_least), lanes.j_most);
    }
    fx = x - i, fy = y - j;
  }
  /// Their element of the window: i + columns j.
  template <class Window>
  HWY_INLINE VI element(const MirroredLanes& lanes, const WindowPlace& place) const {
    const DF d;
    constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
    const VF at = MulAdd(Set(d, static_cast<float>(gathers ? place.pitch : Window::columns)),
                         MulAdd(lanes.sign_j, j, lanes.j), MulAdd(lanes.sign_i, i, lanes.i)) +
                  Set(d, place.origin);
    return ConvertTo(DI(), at);
  }
};

/// The field of slab n of the chunk into place m of `lines`, but for its back plane. `pitch` elements of a slice lie
/// between rows; `voxels` counts, lane by lane, the voxels that live lanes visit.
// Long: three voxels share corners, differences and places along the ray; in parts, each would be given most of them.
template <class Window>
HWY_INLINE void find_line(const MirroredLanes& lanes, const Window& window, const WindowPlace& place, int n,
                          SlabLines& lines, VF& voxels) {
  const int m = n - lines.first;
  const DF d;
  const DI di;
  const VF one = Set(d, 1.0f), half = Set(d, 0.5f);
  const VoxelAt in(lanes, place, n);
  const VF fx = in.fx, fy = in.fy;
  VF u_i = Min((one - fx) * lanes.per_bx, one), u_j = Min((one - fy) * lanes.per_by, one);
  if (HWY_UNLIKELY(!place.inner)) {
    u_i = IfThenElse(in.i == lanes.i_most, one, u_i);
    u_j = IfThenElse(in.j == lanes.j_most, one, u_j);
  }
  const VF u_1 = Min(u_i, u_j), u_2 = Max(u_i, u_j);
  const MF i_first = u_i < u_j, cross_1 = u_1 < one, cross_2 = u_2 < one;
  const auto first = [&](VF a, VF b) HWY_ATTR { return IfThenElse(i_first, a, b); };
  const VF voxel = IfThenElseZero(lanes.live, one);
  voxels = voxels + voxel + (IfThenElseZero(cross_1, voxel) + IfThenElseZero(cross_2, voxel));

  constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
  const auto if_int = [&](MF mask, VI v) HWY_ATTR { return IfThenElseZero(RebindMask(di, mask), v); };
  VI step_p = IfThenElse(RebindMask(di, i_first), lanes.step_i, lanes.step_j),
     step_q = IfThenElse(RebindMask(di, i_first), lanes.step_j, lanes.step_i);
  VI at_00 = in.element<Window>(lanes, place);
  // Lanes that are not there may be anywhere.
  if (gathers) step_p = if_int(lanes.live, step_p), step_q = if_int(lanes.live, step_q);
  if (gathers) at_00 = if_int(lanes.live, at_00);
  const VI at_10 = at_00 + step_p, at_01 = at_00 + step_q, at_11 = at_10 + step_q;
  // What is not crossed has nothing behind it: no step, so that nothing but the voxel's own points is read.
  const VI beyond_p = if_int(cross_1, step_p), beyond_q = if_int(cross_2, step_q);
  const VI at_20 = at_10 + beyond_p, at_21 = at_11 + beyond_p, at_12 = at_11 + beyond_q, at_22 = at_21 + beyond_q;

  const VF b_p = first(lanes.bx, lanes.by), b_q = first(lanes.by, lanes.bx);
  const VF p_0 = first(fx, fy), q_0 = first(fy, fx);
  const VF e_0 = u_1, e_1 = u_2 - u_1, e_2 = one - u_2;
  const VF q_1 = MulAdd(u_1, b_q, q_0), p_2 = e_1 * b_p;

  // The voxel it enters.
  const VF a_10 = window.front(at_10), b_10 = window.back(at_10), a_11 = window.front(at_11), b_11 = window.back(at_11);
  const VF qa = a_11 - a_10, qb = b_11 - b_10, d_qk = qb - qa;
  VF tau_0, third_0;
  {
    const VF a_00 = window.front(at_00), b_00 = window.back(at_00), a_01 = window.front(at_01),
             b_01 = window.back(at_01);
    const VF pa_0 = a_10 - a_00, pa_1 = a_11 - a_01, pb_0 = b_10 - b_00, pb_1 = b_11 - b_01;
    const VF front_0 = MulAdd(p_0, pa_0, a_00), front_1 = MulAdd(p_0, pa_1, a_01);
    lines.s[m] = MulAdd(q_0, front_1 - front_0, front_0);
    const VF d_pq = pa_1 - pa_0;
    third_0 = pb_1 - pb_0 - d_pq;
    const VF p_middle = MulAdd(half * u_1, b_p, p_0);
    const VF weight = NegMulAdd(b_q, one - p_middle, b_p * q_1);
    tau_0 = MulAdd(lanes.bends, d_pq, MulAdd(third_0, weight, b_q * d_qk));
    tau_0 = MulAdd(b_p, pb_0 - pa_0, tau_0);
  }
  {
    const VF a = MulAdd(q_1, qa, a_10), b = MulAdd(q_1, qb, b_10);
    lines.f_1[m] = MulAdd(u_1, b - a, a);
  }

  // Behind p's plane.
  const VF a_21 = window.front(at_21), b_21 = window.back(at_21);
  const VF pa_1 = a_21 - a_11, pb_1 = b_21 - b_11, d_pk = pb_1 - pa_1;
  VF tau_1, third_1;
  {
    const VF a_20 = window.front(at_20), b_20 = window.back(at_20);
    const VF d_pq = pa_1 - (a_20 - a_10);
    third_1 = pb_1 - (b_20 - b_10) - d_pq;
    const VF q_middle = MulAdd(half * e_1, b_q, q_1);
    const VF weight = NegMulAdd(b_p, one - q_middle, lanes.bends * u_2);
    tau_1 = MulAdd(lanes.bends, d_pq, MulAdd(third_1, weight, b_q * d_qk));
    tau_1 = MulAdd(b_p, d_pk, tau_1);
    const VF a = MulAdd(p_2, pa_1, a_11), b = MulAdd(p_2, pb_1, b_11);
    lines.f_2[m] = MulAdd(u_2, b - a, a);
  }

  // Behind q's plane.
  VF tau_2, third_2;
  {
    const VF a_12 = window.front(at_12), b_12 = window.back(at_12), a_22 = window.front(at_22),
             b_22 = window.back(at_22);
    const VF qa_1 = a_12 - a_11, qb_1 = b_12 - b_11;
    const VF d_pq = a_22 - a_21 - qa_1;
    third_2 = b_22 - b_21 - qb_1 - d_pq;
    const VF p_middle = MulAdd(half * e_2, b_p, p_2);
    const VF weight = MulAdd(b_q, p_middle, lanes.bends);
    tau_2 = MulAdd(lanes.bends, d_pq, MulAdd(third_2, weight, b_q * (qb_1 - qa_1)));
    tau_2 = MulAdd(b_p, d_pk, tau_2);
  }

  const VF ee_0 = e_0 * e_0, ee_1 = e_1 * e_1, ee_2 = e_2 * e_2;
  const VF w_0 = ee_0 * tau_0, w_1 = ee_1 * tau_1, w_2 = ee_2 * tau_2;
  lines.u_1[m] = u_1, lines.u_2[m] = u_2;
  lines.sag[m] = Set(d, 1 / 6.0f) * MulAdd(e_0, w_0, MulAdd(e_1, w_1, e_2 * w_2));
  lines.even[0][m] = w_0, lines.even[1][m] = w_1, lines.even[2][m] = w_2;
  const VF odd_0 = lanes.bends * e_0 * ee_0 * third_0, odd_1 = lanes.bends * e_1 * ee_1 * third_1,
           odd_2 = lanes.bends * e_2 * ee_2 * third_2;
  lines.odd[0][m] = odd_0, lines.odd[1][m] = odd_1, lines.odd[2][m] = odd_2;
  const VF even = Max(Max(Abs(w_0), Abs(w_1)), Abs(w_2)), odd = Max(Max(Abs(odd_0), Abs(odd_1)), Abs(odd_2));
  // Not a number where any of them is not: Max may leave that out.
  const VF all = odd_0 + odd_1 + (odd_2 + lines.sag[m]);
  const VF any = MulAdd(Zero(d), all, odd + even);
  lines.bump[m] = Set(d, 0.25f) * any;
}

/// The field at slab n's back plane, into place m + 1.
template <class Window>
HWY_INLINE void find_back(const MirroredLanes& lanes, const Window& window, const WindowPlace& place, int n,
                          SlabLines& lines) {
  const int m = n - lines.first;
  const DI di;
  const VoxelAt in(lanes, place, n + 1);
  const VF fx = in.fx, fy = in.fy;
  constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
  const auto kept = [&](VI v) HWY_ATTR { return gathers ? IfThenElseZero(RebindMask(di, lanes.live), v) : v; };
  const VI at_00 = kept(in.element<Window>(lanes, place)), step_i = kept(lanes.step_i), step_j = kept(lanes.step_j);
  const VI at_10 = at_00 + step_i;
  const VF b_00 = window.back(at_00), b_10 = window.back(at_10), b_01 = window.back(at_00 + step_j),
           b_11 = window.back(at_10 + step_j);
  const VF back_0 = MulAdd(fx, b_10 - b_00, b_00), back_1 = MulAdd(fx, b_11 - b_01, b_01);
  lines.s[m + 1] = MulAdd(fy, back_1 - back_0, back_0);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
