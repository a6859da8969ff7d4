// SPDX-License-Identifier: BSD-3-Clause
// Cuts segments where they cross surfaces, a segment a lane; included once per instruction set (Highway's include guard
// idiom).

#if defined(TESSERA_PROJECTION_LATTICE_CUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_CUT_INL_H_
#undef TESSERA_PROJECTION_LATTICE_CUT_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_CUT_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/lattice/lattice_crossed-inl.h"
#include "projection/surface_crossings.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Lane values in double: two vectors.
struct Doubles {
  V low, high;
};
HWY_INLINE Doubles in_double(VI v) {
  const D d;
  const hn::Half<DI> half;
  return {PromoteTo(d, LowerHalf(half, v)), PromoteTo(d, UpperHalf(half, v))};
}
HWY_INLINE Doubles in_double(VF v) {
  const D d;
  const hn::Half<DF> half;
  return {PromoteTo(d, LowerHalf(half, v)), PromoteTo(d, UpperHalf(half, v))};
}
/// f(vectors), for both halves.
template <class Function, class... Args>
HWY_INLINE Doubles in_halves(const Function& f, const Args&... v) {
  return {f(v.low...), f(v.high...)};
}

/// Cuts segments of the batch whose cells find_surfaces() and find_normals() were called for, and appends what is
/// before a crossing, or the crossing itself (surface_crossings.hpp). A segment's own place holds its last part.
/// Square: whose first pixel is (x0, y0).
class SurfaceCuts {
 public:
  HWY_INLINE SurfaceCuts(const LatticeView& view, const LatticeSurfaces& surfaces, int x0, int y0, SegmentStream& out)
      : perspective_(view.perspective),
        set_(*view.projected.iso->surfaces),
        cells_(surfaces),
        numbers_a_place_(static_cast<std::int32_t>(2 * set_.iso_values().size() + set_.faces())),
        rays_(*view.projected.iso->space, x0, y0),
        out_(out) {}

  HWY_NOINLINE void cut(const CrossedSegments& segments) {
    const DI d;
    for (std::size_t i = 0; i < segments.count; i += lanes) {
      const auto here = FirstN(d, segments.count - i);
      const VI segment = LoadU(d, segments.numbers + i);
      cut_lanes(IfThenElseZero(here, segment), here);
    }
  }

 private:
  using MI = hn::Mask<DI>;

  /// Perspective: directions of the square's rays, at its first pixel, and from one to the next.
  struct Rays {
    glm::dvec3 corner{}, right{}, down{};
    Rays(const PixelSpace& space, int x0, int y0) {
      if (!space.perspective()) return;
      corner = space.direction(x0 + 0.5, y0 + 0.5);
      right = space.direction(x0 + 1.5, y0 + 0.5) - corner;
      down = space.direction(x0 + 0.5, y0 + 1.5) - corner;
    }
  };

  /// A part of the segments in the making: where it begins, and with which scalar or mark.
  struct Part {
    VI front;
    VF scalar;
  };

  template <class T>
  static HWY_INLINE hn::Vec<hn::ScalableTag<T>> number_of_cell(const T* numbers, VI cell) {
    const hn::ScalableTag<T> d;
    if constexpr (lanes == static_cast<int>(LatticeSurfaces::most_cells))
      return TableLookupLanes(Load(d, numbers), IndicesFromVec(d, cell));
    else
      return GatherIndex(d, numbers, cell);
  }

  HWY_INLINE void cut_lanes(VI segment, MI here) {
    const DI d;
    const DF df;
    const VI hit = GatherIndex(d, out_.hit.data(), segment);
    const VI cell = And(hit, Set(d, static_cast<std::int32_t>(LatticeSurfaces::most_cells) - 1));
    const VI front = GatherIndex(d, out_.front.data(), segment), back = GatherIndex(d, out_.back.data(), segment);
    const VF from = GatherIndex(df, out_.scalar_front.data(), segment),
             to = GatherIndex(df, out_.scalar_back.data(), segment);
    const VI pixel = GatherIndex(d, out_.pixel.data(), segment);
    const VI first = number_of_cell(cells_.first, cell);
    const VI count = IfThenElseZero(here, number_of_cell(cells_.count, cell));
    const auto most = static_cast<std::size_t>(GetLane(MaxOfLanes(d, count)));
    // Each crossing appends one.
    if (out_.size + most * lanes > out_.front.size() - SegmentStream::padding)
      out_.reserve(2 * (out_.size + most * lanes));

    const MI rises = RebindMask(d, from < to);
    const VI cosine = cosine_code(hit, cell);
    const Doubles steps = in_double(back - front), start = in_double(front), scalar = in_double(from);
    const Doubles slope = in_halves([](V s, V a, V b) HWY_ATTR { return s / (b - a); }, steps, scalar, in_double(to));
    const VI limit = Max(front, back - Set(d, back_end_steps));
    const VI at_limit = IfThenElse(limit > front, place(Place::back_end), place(Place::inside));
    const MI level = front == back;
    Part part{front, from};
    for (std::size_t k = 0; k < most; ++k) {
      const VI kth = Set(d, static_cast<std::int32_t>(k));
      const VI passed = IfThenElse(rises, kth, count - Set(d, 1) - kth);
      const MI has = kth < count;
      const VI surface = IfThenElseZero(has, first + passed);
      const VF value = k == 0 ? first_values(rises, cell) : GatherIndex(df, set_.on_lattice().data(), surface);
      const MI crossed = And(has, RebindMask(d, Xor(from >= value, to >= value)));
      if (AllFalse(d, crossed)) continue;
      const auto depth_at = [](V v, V f, V s, V l, V z) HWY_ATTR {
        const V along = (v - f) * s;
        return Round(z + Min(Max(along, Zero(D())), l));
      };
      VI depth = in_steps(in_halves(depth_at, in_double(value), scalar, slope, steps, start));
      const MI at_back = Not(depth < limit);
      const VI at =
          IfThenElse(at_back, at_limit, IfThenElse(depth == front, place(Place::front_end), place(Place::inside)));
      depth = Min(depth, limit);
      const VF mark = mark_of(surface, rises, at, cosine);
      // One at the back end stands alone; so does the first of two at the front.
      const MI alone = And(crossed, Or(at == place(Place::back_end), level));
      const MI before = AndNot(alone, crossed);
      const MI at_front = And(before, depth == part.front);
      const MI marked = RebindMask(d, part.scalar >= Set(df, LatticeMark::first));
      const MI parts = Or(alone, AndNot(AndNot(marked, at_front), before));
      const VI begin = IfThenElse(alone, depth, part.front);
      const VF begin_scalar = IfThenElse(RebindMask(df, alone), mark, part.scalar);
      append(RebindMask(df, parts), pixel, begin, depth, begin_scalar, value, out_);
      part.front = IfThenElse(before, depth, part.front);
      part.scalar = IfThenElse(RebindMask(df, before), mark, part.scalar);
    }
    // Lanes without a segment go behind the last.
    const VI spare = Iota(d, 0) + Set(d, static_cast<std::int32_t>(out_.size));
    const VI own = IfThenElse(here, segment, spare);
    ScatterIndex(part.front, d, out_.front.data(), own);
    ScatterIndex(part.scalar, df, out_.scalar_front.data(), own);
  }

  using Place = scene::SurfaceSet::Place;
  /// The lowest number of a crossing there.
  HWY_INLINE VI place(Place p) const { return Set(DI(), static_cast<std::int32_t>(p) * numbers_a_place_); }

  /// The surfaces that the cells' segments may cross first.
  HWY_INLINE VF first_values(MI rises, VI cell) const {
    return IfThenElse(RebindMask(DF(), rises), number_of_cell(cells_.low, cell), number_of_cell(cells_.high, cell));
  }

  /// Whole numbers of 31 bits.
  static HWY_INLINE VI in_steps(Doubles v) {
    const hn::Half<DI> half;
    return Combine(DI(), DemoteTo(half, v.high), DemoteTo(half, v.low));
  }

  /// LatticeMark::of(the crossing).
  HWY_INLINE VF mark_of(VI surface, MI rises, VI at, VI cosine) const {
    const DI d;
    const auto n = static_cast<std::int32_t>(set_.iso_values().size());
    const VI within = IfThenElse(rises, surface, Set(d, 2 * n - 1) - surface);
    const VI bits = Or(ShiftLeft<LatticeMark::cosine_bits>(at + within), cosine);
    return BitCast(DF(), bits + Set(d, static_cast<std::int32_t>(LatticeMark::first_bits)));
  }

  /// The lower bits of the lanes' marks.
  HWY_INLINE VI cosine_code(VI hit, VI cell) const {
    const DI d;
    const DF df;
    if (!perspective_) return number_of_cell(cells_.cosine_code, cell);
    const VF codes = cosine_of_rays(hit, cell) * Set(df, static_cast<float>(LatticeMark::cosines));
    return ConvertTo(d, codes + Set(df, 0.5f));
  }

  static HWY_INLINE VF in_float(Doubles v) {
    const hn::Half<DF> half;
    return Combine(DF(), DemoteTo(half, v.high), DemoteTo(half, v.low));
  }
  static HWY_INLINE Doubles doubles_of_cells(const double* numbers, VI cell) {
    const D d;
    const hn::RebindToSigned<D> di;
    const hn::Half<DI> half;
    return {GatherIndex(d, numbers, PromoteTo(di, LowerHalf(half, cell))),
            GatherIndex(d, numbers, PromoteTo(di, UpperHalf(half, cell)))};
  }

  HWY_INLINE VF cosine_of_rays(VI hit, VI cell) const {
    const DI d;
    const VI side = Set(d, SegmentWindows::side - 1);
    const Doubles column = in_double(And(ShiftRight<Hit::column_bit>(hit), side));
    const Doubles row = in_double(And(ShiftRight<Hit::row_bit>(hit), side));
    const auto on_ray = [&](int axis) HWY_ATTR {
      const V corner = Set(D(), rays_.corner[axis]), right = Set(D(), rays_.right[axis]),
              down = Set(D(), rays_.down[axis]);
      return in_halves([&](V c, V r) HWY_ATTR { return corner + right * c + down * r; }, column, row);
    };
    const Doubles x = on_ray(0), y = on_ray(1), z = on_ray(2);
    const auto between = [](V ax, V ay, V az, V bx, V by, V bz, V without) HWY_ATTR {
      const V along = ax * bx + ay * by + az * bz;
      const V length = ax * ax + ay * ay + az * az;
      return Min(Max(Abs(along) / Sqrt(length), without), Set(D(), 1));
    };
    return in_float(in_halves(between, x, y, z, doubles_of_cells(cells_.normal[0], cell),
                              doubles_of_cells(cells_.normal[1], cell), doubles_of_cells(cells_.normal[2], cell),
                              doubles_of_cells(cells_.least_cosine, cell)));
  }

  bool perspective_;
  const scene::SurfaceSet& set_;
  const LatticeSurfaces& cells_;
  std::int32_t numbers_a_place_;
  Rays rays_;
  SegmentStream& out_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
