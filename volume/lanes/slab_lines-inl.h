// SPDX-License-Identifier: BSD-3-Clause
// The field along a packet's rays in slabs that they cross from plane to plane. Included once per instruction set
// (Highway's include guard idiom).
//
// What      For up to eight slabs: the field where a ray meets the slab's front plane, its back plane and the planes of
//           axes i and j between them, and the shape of the cubic that the field is between consecutive crossings. From
//           these, slabs are integrated as lines (line_of()) or as separate stretches (voxel_pieces-inl.h).
// Axes      i and j are mirrored, lane by lane, where a ray moves downwards, so that all slopes are positive. p is the
//           axis whose plane a ray crosses first, at u_1 in the slab, and q the other, at u_2; 1 if not crossed. A ray
//           that crosses both planes passes through three voxels of the slab and uses eight lattice points in each
//           slice, which are numbered by their positions along p and q relative to the voxel that it enters:
//
//             q = 2       12 ------ 22
//                          |    x    |       * where it enters
//                          |  third  |       1 p's plane, at u_1
//             q = 1 01 -- 11 --2--- 21       2 q's plane, at u_2
//                    |first|  second |       x where it leaves
//                    | *   1         |
//             q = 0 00 -- 10 ------ 20
//                   p = 0  1         2
//
//           a_pq is the sample at such a point in the slab's front slice, b_pq that at the same point in the back
//           slice.
// Cubic     Inside a voxel the field is trilinear in p, q and u, and therefore a cubic in u along the ray. With the
//           ray's slopes p' and q', half its second derivative is
//             tau = p' q' D_pq + p' D_pk + q' D_qk.
//           Each D is a mixed difference of the voxel's samples, linear along the third axis with the slope D_pqk. If
//           D_pk and D_qk are taken at the faces q_s and p_s, and D_pq in the front slice, tau in the middle (p, q, u)
//           of a stretch has the additional term D_pqk (p' q' u + p' (q - q_s) + q' (p - p_s)). Stretches that share a
//           face share its differences. The mean of a stretch of extent e in the slab is tau e^2 / 6 below the mean of
//           its ends (Simpson's rule, which is exact for cubics).
// Line      The field is the line between the slab's ends plus a deviation: d_1 and d_2 at the crossings, and between
//           them the cubics' bumps, at most e^2 |tau| / 4 for the even part and e^3 p' q' |D_pqk| / 4 for the odd part
//           (Bezier).
// Bits      A lane's numbers depend on its ray, the chunk and the samples, not on the window that provides the samples.
// Ends      NaN from blank samples is preserved in `bump` and `rho`.

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

/// Axis i or j of a packet's lanes, mirrored; see Axes above.
struct MirroredAxis {
  VF start, slope, per_slope;  ///< position at the chunk's first plane; slope per slab, >= 0; its inverse, finite
  VF least, most;              ///< voxels of the volume
  VF sign;                     ///< +1, or -1 where mirrored
  VF origin;                   ///< lattice point 0, relative to the packet's i_base or j_base
  VI step;                     ///< elements of the window from one lattice point to the next

  /// Sets up the axis for a ray at `place` + `change` k. `stride`: elements of the window between points before
  /// mirroring.
  HWY_INLINE MirroredAxis(VF place, VF change, VF first, VF last, VF point_0, int stride) : origin(point_0) {
    const DF d;
    const VF one = Set(d, 1.0f);
    const MF down = change < Zero(d);
    sign = IfThenElse(down, Neg(one), one);
    start = sign * place;
    slope = Abs(change);
    per_slope = one / Max(slope, Set(d, 1e-30f));
    least = IfThenElse(down, Neg(last) - one, first);
    most = IfThenElse(down, Neg(first) - one, last);
    step = ConvertTo(DI(), Set(d, static_cast<float>(stride)) * sign);
  }
};

/// A packet's lanes in mirrored axes.
struct MirroredLanes {
  MirroredAxis i, j;
  MF live;
  VF slopes_product;

  /// `columns`: number of columns of the window.
  HWY_INLINE MirroredLanes(const Lanes& lanes, int columns)
      : i(lanes.x, lanes.bx, lanes.i_least, lanes.i_most, lanes.i, 1),
        j(lanes.y, lanes.by, lanes.j_least, lanes.j_most, lanes.j, columns),
        live(lanes.k_in < lanes.k_out),
        slopes_product(i.slope * j.slope) {}
};

/// The field in up to eight slabs; `s` contains the field at each slab's front plane.
struct SlabLines {
  static constexpr int most = 8;
  int first;  ///< the slab stored at index 0
  VF s[most + 1];
  VF u_1[most], u_2[most], f_1[most], f_2[most];  ///< positions of the crossings, and the field there
  VF sag[most];                                   ///< sum of e^3 tau / 6
  VF bump[most];
  VF even[3][most], odd[3][most];  ///< for each stretch: e^2 tau, and the coefficient of the odd part of the cubic
};

/// A slab as one line. The mean is `shift` above the mean of its ends, and the field is within rho of the line. NaN
/// where the field is NaN.
struct Line {
  VF s_0, s_1, span, shift, rho;

  /// Returns the line, with zeros except in `lanes`.
  HWY_INLINE Line kept(MF lanes) const {
    const auto keep = [&](VF v) HWY_ATTR { return IfThenElseZero(lanes, v); };
    return {keep(s_0), keep(s_1), keep(span), keep(shift), keep(rho)};
  }
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
  // Trapezoidal rule: each weight is half the extent of the adjacent stretches.
  const VF kinks = MulAdd(d_1, u_2, d_2 * (one - u_1));
  line.shift = half * kinks - lines.sag[n];
  line.rho = Max(Abs(d_1), Abs(d_2)) + lines.bump[n];
  return line;
}

/// Second-order properties of a slab's field, without the odd parts of its cubics. Let r be the deviation from the line
/// (kinks and the cubics' even parts), m the mean of r, and u the position from 0 to 1:
///   product     the integral of the field's square minus that of the square of (line + m), for products of functions
///               that are linear in the field,
///   covariance  the covariance of r and u,
///   odd         an upper bound of the omitted parts.
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
    // The deviation is a chord from p to q plus a parabola of height b.
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

/// The position of a slab's window, and whether all voxels that may be met have neighbours in the volume.
struct WindowPlace {
  const float *front, *back;
  float origin;          ///< element of voxel (i_base, j_base), negative
  std::ptrdiff_t pitch;  ///< elements of a slice between rows
  bool inner;
};

/// The voxels of the lanes at plane n of the chunk, in mirrored axes, and the lanes' positions in these voxels.
struct VoxelAt {
  VF i, j;
  VF part_i, part_j;  ///< position relative to the voxel's corner, 0 to 1

  HWY_INLINE VoxelAt(const MirroredLanes& lanes, const WindowPlace& place, int n) {
    const VF k = Set(DF(), static_cast<float>(n));
    const VF at_i = MulAdd(k, lanes.i.slope, lanes.i.start), at_j = MulAdd(k, lanes.j.slope, lanes.j.start);
    i = Floor(at_i), j = Floor(at_j);
    if (HWY_UNLIKELY(!place.inner)) {
      i = Min(Max(i, lanes.i.least), lanes.i.most);
      j = Min(Max(j, lanes.j.least), lanes.j.most);
    }
    part_i = at_i - i, part_j = at_j - j;
  }
  /// Index of the voxels in the window: i + columns j.
  template <class Window>
  HWY_INLINE VI element(const MirroredLanes& lanes, const WindowPlace& place) const {
    const DF d;
    constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
    const VF at = MulAdd(Set(d, static_cast<float>(gathers ? place.pitch : Window::columns)),
                         MulAdd(lanes.j.sign, j, lanes.j.origin), MulAdd(lanes.i.sign, i, lanes.i.origin)) +
                  Set(d, place.origin);
    return ConvertTo(DI(), at);
  }
};

/// The samples at a lattice point in a slab's front and back slice, or the difference of two such pairs.
struct SamplePair {
  VF a, b;

  friend HWY_INLINE SamplePair operator-(const SamplePair& to, const SamplePair& from) {
    return {to.a - from.a, to.b - from.b};
  }
  HWY_INLINE VF change() const { return b - a; }
  /// Returns the value at u, interpolated between the slices.
  HWY_INLINE VF at(VF u) const { return MulAdd(u, b - a, a); }
  /// Returns the pair plus `part` times `step`.
  HWY_INLINE SamplePair moved(VF part, const SamplePair& step) const {
    return {MulAdd(part, step.a, a), MulAdd(part, step.b, b)};
  }
};

/// The shape of the cubic over a stretch: tau in the middle of the stretch, and D_pqk.
struct Curvature {
  VF tau, third;
};

/// The terms of tau except D_pq; see Cubic above.
struct SideDifferences {
  VF d_pk, d_qk;
  VF offset;  ///< p' q' u + p' (q - q_s) + q' (p - p_s) at the stretch's middle
};

/// A ray's slopes along p and q.
struct Slopes {
  VF p, q, product;
};

/// Returns the curvature in a voxel. Its samples differ by `near` along one axis and, one step further along the other
/// axis, by `far`.
HWY_INLINE Curvature curvature(const Slopes& slope, const SamplePair& near, const SamplePair& far,
                               const SideDifferences& sides) {
  const VF d_pq = far.a - near.a, third = far.b - near.b - d_pq;
  const VF tau = MulAdd(slope.product, d_pq, MulAdd(third, sides.offset, slope.q * sides.d_qk));
  return {MulAdd(slope.p, sides.d_pk, tau), third};
}

/// Stores the crossings and the shapes of the stretches between them at index m of `lines`.
HWY_INLINE void set_stretches(VF u_1, VF u_2, VF slopes_product, const Curvature (&shape)[3], int m, SlabLines& lines) {
  const DF d;
  const VF extent[3] = {u_1, u_2 - u_1, Set(d, 1.0f) - u_2};
  VF even[3], odd[3];
  for (int k = 0; k < 3; ++k) {
    const VF squared = extent[k] * extent[k];
    even[k] = squared * shape[k].tau;
    odd[k] = slopes_product * extent[k] * squared * shape[k].third;
    lines.even[k][m] = even[k], lines.odd[k][m] = odd[k];
  }
  lines.u_1[m] = u_1, lines.u_2[m] = u_2;
  const VF sag = MulAdd(extent[0], even[0], MulAdd(extent[1], even[1], extent[2] * even[2]));
  lines.sag[m] = Set(d, 1 / 6.0f) * sag;
  const VF most_even = Max(Max(Abs(even[0]), Abs(even[1])), Abs(even[2])),
           most_odd = Max(Max(Abs(odd[0]), Abs(odd[1])), Abs(odd[2]));
  // The result is NaN where any of these is NaN, because Max may drop NaN.
  const VF all = odd[0] + odd[1] + (odd[2] + lines.sag[m]);
  lines.bump[m] = Set(d, 0.25f) * MulAdd(Zero(d), all, most_odd + most_even);
}

/// Stores the field of slab n of the chunk, except at the back plane, in `lines`. `voxels` counts, for each lane, the
/// voxels that live lanes visit.
template <class Window>
HWY_INLINE void find_line(const MirroredLanes& lanes, const Window& window, const WindowPlace& place, int n,
                          SlabLines& lines, VF& voxels) {
  const int m = n - lines.first;
  const DF d;
  const DI di;
  const VF one = Set(d, 1.0f), half = Set(d, 0.5f);
  const VoxelAt in(lanes, place, n);
  VF u_i = Min((one - in.part_i) * lanes.i.per_slope, one), u_j = Min((one - in.part_j) * lanes.j.per_slope, one);
  if (HWY_UNLIKELY(!place.inner)) {
    u_i = IfThenElse(in.i == lanes.i.most, one, u_i);
    u_j = IfThenElse(in.j == lanes.j.most, one, u_j);
  }
  const VF u_1 = Min(u_i, u_j), u_2 = Max(u_i, u_j);
  const MF i_is_p = u_i < u_j, crosses_p = u_1 < one, crosses_q = u_2 < one;
  const VF voxel = IfThenElseZero(lanes.live, one);
  voxels = voxels + voxel + (IfThenElseZero(crosses_p, voxel) + IfThenElseZero(crosses_q, voxel));

  constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
  const auto if_int = [&](MF mask, VI v) HWY_ATTR { return IfThenElseZero(RebindMask(di, mask), v); };
  VI step_p = IfThenElse(RebindMask(di, i_is_p), lanes.i.step, lanes.j.step),
     step_q = IfThenElse(RebindMask(di, i_is_p), lanes.j.step, lanes.i.step);
  VI at_00 = in.element<Window>(lanes, place);
  // Lanes that are not live may have any position.
  if (gathers) step_p = if_int(lanes.live, step_p), step_q = if_int(lanes.live, step_q);
  if (gathers) at_00 = if_int(lanes.live, at_00);
  const VI at_10 = at_00 + step_p, at_01 = at_00 + step_q, at_11 = at_10 + step_q;
  // If a plane is not crossed, the step beyond it is zero, so that only the voxel's own points are read.
  const VI beyond_p = if_int(crosses_p, step_p), beyond_q = if_int(crosses_q, step_q);
  const VI at_20 = at_10 + beyond_p, at_21 = at_11 + beyond_p, at_12 = at_11 + beyond_q, at_22 = at_21 + beyond_q;
  const auto samples = [&](VI at) HWY_ATTR { return SamplePair{window.front(at), window.back(at)}; };

  const auto first = [&](VF of_i, VF of_j) HWY_ATTR { return IfThenElse(i_is_p, of_i, of_j); };
  const Slopes slope{first(lanes.i.slope, lanes.j.slope), first(lanes.j.slope, lanes.i.slope), lanes.slopes_product};
  const VF p_0 = first(in.part_i, in.part_j), q_0 = first(in.part_j, in.part_i);
  const VF q_1 = MulAdd(u_1, slope.q, q_0), p_2 = (u_2 - u_1) * slope.p;  // p_2 is relative to p's plane

  Curvature shape[3];
  const SamplePair s_10 = samples(at_10), s_11 = samples(at_11), along_q = s_11 - s_10;
  {
    const SamplePair s_00 = samples(at_00), s_01 = samples(at_01), near = s_10 - s_00, far = s_11 - s_01;
    const VF front_0 = MulAdd(p_0, near.a, s_00.a), front_1 = MulAdd(p_0, far.a, s_01.a);
    lines.s[m] = MulAdd(q_0, front_1 - front_0, front_0);
    // Faces q = 0 and p = 1.
    const VF p_middle = MulAdd(half * u_1, slope.p, p_0);
    const VF offset = NegMulAdd(slope.q, one - p_middle, slope.p * q_1);
    shape[0] = curvature(slope, near, far, {near.change(), along_q.change(), offset});
  }
  lines.f_1[m] = s_10.moved(q_1, along_q).at(u_1);

  const SamplePair s_21 = samples(at_21), along_p = s_21 - s_11;
  {
    // Faces q = 1 and p = 1.
    const VF q_middle = MulAdd(half * (u_2 - u_1), slope.q, q_1);
    const VF offset = NegMulAdd(slope.p, one - q_middle, slope.product * u_2);
    shape[1] = curvature(slope, samples(at_20) - s_10, along_p, {along_p.change(), along_q.change(), offset});
  }
  lines.f_2[m] = s_11.moved(p_2, along_p).at(u_2);
  {
    // Faces q = 1 and p = 1 again; the latter now begins at 11.
    const SamplePair s_12 = samples(at_12), near = s_12 - s_11;
    const VF p_middle = MulAdd(half * (one - u_2), slope.p, p_2);
    const VF offset = MulAdd(slope.q, p_middle, slope.product);
    shape[2] = curvature(slope, near, samples(at_22) - s_21, {along_p.change(), near.change(), offset});
  }
  set_stretches(u_1, u_2, slope.product, shape, m, lines);
}

/// Stores the field at slab n's back plane.
template <class Window>
HWY_INLINE void find_back(const MirroredLanes& lanes, const Window& window, const WindowPlace& place, int n,
                          SlabLines& lines) {
  const int m = n - lines.first;
  const DI di;
  const VoxelAt in(lanes, place, n + 1);
  constexpr bool gathers = std::is_same_v<Window, GatherWindow>;
  const auto kept = [&](VI v) HWY_ATTR { return gathers ? IfThenElseZero(RebindMask(di, lanes.live), v) : v; };
  const VI at_00 = kept(in.element<Window>(lanes, place)), step_i = kept(lanes.i.step), step_j = kept(lanes.j.step);
  const VI at_10 = at_00 + step_i;
  const VF b_00 = window.back(at_00), b_10 = window.back(at_10), b_01 = window.back(at_00 + step_j),
           b_11 = window.back(at_10 + step_j);
  const VF back_0 = MulAdd(in.part_i, b_10 - b_00, b_00), back_1 = MulAdd(in.part_i, b_11 - b_01, b_01);
  lines.s[m + 1] = MulAdd(in.part_j, back_1 - back_0, back_0);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::volume
HWY_AFTER_NAMESPACE();

#endif
