// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "integrals/segment_integrator.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrals/integrate_exact.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "hwy/contrib/math/math-inl.h"
#include "integrals/piecewise_table-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tessera::integrals {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Gauss-Legendre nodes and weights on [0, 1].
constexpr double nodes3[3] = {0.1127016653792583, 0.5, 0.8872983346207417};
constexpr double weights3[3] = {0.2777777777777778, 0.4444444444444444, 0.2777777777777778};
constexpr double nodes6[6] = {0.03376524289842399, 0.16939530676686774, 0.38069040695840155,
                              0.61930959304159845, 0.83060469323313226, 0.96623475710157601};
constexpr double weights6[6] = {0.08566224618958517, 0.18038078652406930, 0.23395696728634552,
                                0.23395696728634552, 0.18038078652406930, 0.08566224618958517};

/// int_0^1 exp(-q) du and int_0^1 u exp(-q) du for q(u) = u (linear + quadratic u).
struct Moments {
  V zeroth, first;
};

template <int count>
HWY_INLINE Moments moments(V linear, V quadratic, const double (&nodes)[count], const double (&weights)[count]) {
  const D d;
  Moments m{Zero(d), Zero(d)};
  for (int i = 0; i < count; ++i) {
    const V u = Set(d, nodes[i]);
    const V q = u * MulAdd(quadratic, u, linear);
    const V light = Set(d, weights[i]) * Exp(d, Neg(q));
    m.zeroth = m.zeroth + light;
    m.first = MulAdd(light, u, m.first);
  }
  return m;
}

/// exp(-x) for 0 <= x <= 0.05, to 1e-15.
HWY_INLINE V thin_exp(V x) {
  const D d;
  V sum = Set(d, -1.0 / 5040);
  for (const double c : {1.0 / 720, -1.0 / 120, 1.0 / 24, -1.0 / 6, 0.5, -1.0, 1.0}) sum = MulAdd(sum, x, Set(d, c));
  return sum;
}

/// Computes int_0^1 exp(-q) du by the series 1 - q + q^2/2 - q^3/6 + q^4/24, integrating each power as a polynomial.
/// The omitted term q^5 / 120 is below 3e-9 for an optical depth of 0.05.
HWY_INLINE V thin_zeroth(V a, V b) {
  const D d;
  const auto number = [&](double value) HWY_ATTR { return Set(d, value); };
  const V ab = a * b, a2 = a * a, b2 = b * b;
  const V q1 = MulAdd(a, number(1.0 / 2), b * number(1.0 / 3));
  const V q2 = MulAdd(a2, number(1.0 / 3), MulAdd(ab, number(1.0 / 2), b2 * number(1.0 / 5)));
  const V q3 = MulAdd(a, MulAdd(a2, number(1.0 / 4), ab * number(3.0 / 5)),
                      b * MulAdd(ab, number(1.0 / 2), b2 * number(1.0 / 7)));
  const V q4 = MulAdd(a2, MulAdd(a2, number(1.0 / 5), MulAdd(ab, number(2.0 / 3), b2 * number(6.0 / 7))),
                      b2 * MulAdd(ab, number(1.0 / 2), b2 * number(1.0 / 9)));
  return MulAdd(q4, number(1.0 / 24), MulAdd(q3, number(-1.0 / 6), MulAdd(q2, number(0.5), number(1.0) - q1)));
}

/// Upper bound of the number of pieces of a segment: one per interval, and the pieces that are cut from thick ones. The
/// transmittance of each cut piece is at most exp(-1), so the rest of the segment is negligible after a few pieces.
template <class Table>
std::size_t most_pieces(const Table& table) {
  constexpr std::size_t thick = 64;
  return table.base.size() + thick;
}

/// Looks up one column of the table at each lane's interval. `in_register`: the whole column fits in one vector.
template <bool in_register>
HWY_INLINE V lookup(const std::vector<double>& table, VI interval) {
  const D d;
  if constexpr (in_register) return TableLookupLanes(LoadU(d, table.data()), IndicesFromVec(d, interval));
  return GatherIndex(d, table.data(), interval);
}

/// A piece of a segment: extinction at its front and back, linear between them, length and optical depth.
struct Piece {
  V kappa0, kappa1, length, depth;
};

/// Returns the fraction of a piece whose optical depth is most_depth, in lanes of `thick`, and 1 in other lanes. It is
/// the solution of q(u) = most_depth in the form without cancellation.
HWY_INLINE V part_of_depth(const Piece& piece, V twice_most_depth, hn::Mask<D> thick) {
  const D d;
  const V one = Set(d, 1.0);
  const V linear = piece.kappa0 * piece.length, rise = (piece.kappa1 - piece.kappa0) * piece.length;
  const V root = Sqrt(Max(Zero(d), MulAdd(linear, linear, twice_most_depth * rise)));
  return IfThenElse(thick, Min(one, twice_most_depth / (linear + root)), one);
}

/// The transmittance of a piece, and its moments where they are needed.
struct Passage {
  V through;
  Moments m;
};

/// `varies` marks lanes whose colour varies over the piece. Each lane chooses the thin or the thick formula by itself,
/// so that a segment's bits do not depend on its neighbours in the batch.
HWY_INLINE Passage pass(const Piece& piece, hn::Mask<D> varies, hn::Mask<D> active, bool emits_by_extinction) {
  const D d;
  const auto thin = piece.depth < Set(d, 0.05);
  const auto needs_exp = AndNot(thin, active);
  const bool some_thin = !AllTrue(d, needs_exp), some_thick = !AllFalse(d, needs_exp);
  const bool some_vary = !emits_by_extinction || !AllFalse(d, And(varies, active));
  const V linear = piece.kappa0 * piece.length;
  const V quadratic = Set(d, 0.5) * ((piece.kappa1 - piece.kappa0) * piece.length);
  Passage p{Set(d, 1.0), {Zero(d), Zero(d)}};
  if (some_thin) {
    p.through = thin_exp(piece.depth);
    if (!emits_by_extinction)
      p.m = moments(linear, quadratic, nodes3, weights3);
    else if (some_vary)
      p.m.zeroth = thin_zeroth(linear, quadratic);
  }
  if (some_thick) {
    p.through = IfThenElse(thin, p.through, Exp(d, Neg(piece.depth)));
    if (some_vary) {
      const Moments fine = moments(linear, quadratic, nodes6, weights6);
      p.m = {IfThenElse(thin, p.m.zeroth, fine.zeroth), IfThenElse(thin, p.m.first, fine.first)};
    }
  }
  return p;
}

/// Returns the light of one colour that leaves the front of the piece. For emission by absorption, this is
///   c0 (1 - M) + c1 (M - T) = c0 (1 - T) + (c1 - c0) (M - T);
/// the second term is omitted where the colour is constant.
HWY_INLINE V light_of(V color0, V color1, V length, const Passage& p, hn::Mask<D> varies, bool emits_by_extinction) {
  const D d;
  const V change = color1 - color0;
  if (!emits_by_extinction) return length * MulAdd(change, p.m.first, color0 * p.m.zeroth);
  const V light = color0 * (Set(d, 1.0) - p.through);
  return IfThenElse(varies, MulAdd(change, p.m.zeroth - p.through, light), light);
}

template <bool in_register>
void exact(const PiecewiseTable& table, scene::Emission emission, const ExactPieces& pieces, SegmentBatch& batch) {
  const D d;
  const DI di;
  const V zero = Zero(d), one = Set(d, 1.0), half = Set(d, 0.5);
  const V most_depth = Set(d, pieces.optical_depth), twice_most_depth = Set(d, 2 * pieces.optical_depth);
  const V least_transmittance = Set(d, pieces.transmittance);
  const auto lanes = static_cast<std::size_t>(hn::Lanes(d));
  const auto step_up = Set(di, 1), step_down = Set(di, -1);
  const bool emits_by_extinction = emission == scene::Emission::absorption;

  for (std::size_t i = 0; i < batch.size; i += lanes) {
    const auto in_batch = Iota(d, 0) < Set(d, static_cast<double>(batch.size - i));
    const V length = IfThenElseZero(in_batch, LoadU(d, &batch.length[i]));
    const V front = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_front[i]));
    const V back = IfThenElseZero(in_batch, LoadU(d, &batch.scalar_back[i]));
    const auto constant = front == back;
    const auto up = back >= front;
    const V length_per_scalar = length / IfThenElse(constant, one, back - front);

    VI interval = locate(table, front, up);
    V scalar = front, left = length;
    V color[3] = {zero, zero, zero}, transmittance = one, optical_depth = zero;
    auto active = length > zero;
    for (std::size_t pieces = most_pieces(table); pieces > 0 && !AllFalse(d, active); --pieces) {
      const V knot =
          IfThenElse(up, lookup<in_register>(table.above, interval), lookup<in_register>(table.below, interval));
      V target = IfThenElse(up, Min(knot, back), Max(knot, back));
      target = IfThenElse(constant, back, target);
      auto last = target == back;
      Piece piece;
      piece.length = IfThenElse(last, left, Min(left, (target - scalar) * length_per_scalar));

      const V base = lookup<in_register>(table.base, interval);
      const V from = scalar - base;
      V to = target - base;
      const auto channel = [&](int c, V& at_from, V& at_to) HWY_ATTR {
        const V start = lookup<in_register>(table.channels[c].start, interval);
        const V slope = lookup<in_register>(table.channels[c].slope, interval);
        at_from = MulAdd(slope, from, start);
        at_to = MulAdd(slope, to, start);
      };
      channel(0, piece.kappa0, piece.kappa1);
      piece.depth = piece.length * (half * (piece.kappa0 + piece.kappa1));
      const auto thick = piece.depth > most_depth;
      if (!AllFalse(d, thick)) {
        const V u = part_of_depth(piece, twice_most_depth, thick);
        piece.length = piece.length * u;
        piece.kappa1 = IfThenElse(thick, MulAdd(piece.kappa1 - piece.kappa0, u, piece.kappa0), piece.kappa1);
        target = IfThenElse(thick, MulAdd(target - scalar, u, scalar), target);
        to = target - base;
        piece.depth = piece.length * (half * (piece.kappa0 + piece.kappa1));
        last = AndNot(thick, last);
      }
      V color0[3], color1[3];
      auto varies = zero < zero;
      for (int c = 0; c < 3; ++c) {
        channel(c + 1, color0[c], color1[c]);
        varies = Or(varies, color0[c] != color1[c]);
      }
      const Passage passage = pass(piece, varies, active, emits_by_extinction);
      for (int c = 0; c < 3; ++c) {
        const V light = light_of(color0[c], color1[c], piece.length, passage, varies, emits_by_extinction);
        color[c] = IfThenElse(active, MulAdd(transmittance, light, color[c]), color[c]);
      }
      optical_depth = IfThenElse(active, optical_depth + piece.depth, optical_depth);
      transmittance = IfThenElse(active, transmittance * passage.through, transmittance);
      left = left - piece.length;
      scalar = target;
      active = AndNot(Or(last, transmittance < least_transmittance), active);
      const auto on = RebindMask(di, AndNot(thick, active));
      interval = interval + IfThenElseZero(on, IfThenElse(RebindMask(di, up), step_up, step_down));
    }
    StoreU(color[0], d, &batch.red[i]);
    StoreU(color[1], d, &batch.green[i]);
    StoreU(color[2], d, &batch.blue[i]);
    StoreU(optical_depth, d, &batch.optical_depth[i]);
    StoreU(transmittance, d, &batch.transmittance[i]);
  }
}

void exact_on_lanes(const PiecewiseTable& table, scene::Emission emission, SegmentBatch& batch,
                    const ExactPieces& pieces) {
  if (table.knot_count + 1 <= hn::Lanes(D()))
    exact<true>(table, emission, pieces, batch);
  else
    exact<false>(table, emission, pieces, batch);
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::integrals
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tessera::integrals {
HWY_EXPORT(exact_on_lanes);
void integrate_exact(const PiecewiseTable& table, scene::Emission emission, SegmentBatch& batch,
                     const ExactPieces& pieces) {
  HWY_DYNAMIC_DISPATCH(exact_on_lanes)(table, emission, batch, pieces);
}
}  // namespace tessera::integrals
#endif  // HWY_ONCE
