// SPDX-License-Identifier: BSD-3-Clause
// Cuts segments where they cross iso-surfaces, one segment per lane. Included once per instruction set (Highway's
// include guard idiom).
//
// What      A segment from depth z_0 to z_1 with scalars s_0 to s_1 crosses the surface of value v, if v is between s_0
//           and s_1, at the depth z_0 + (v - s_0) (z_1 - z_0) / (s_1 - s_0), rounded to a step of the lattice. The
//           segment is replaced by the parts between its crossings; a part's front scalar is the mark of the crossing
//           at which the part begins (surface_crossings.hpp).
// Accuracy  Depths are computed in double precision, and rounded to half a step. Cosines of normal and ray are computed
//           in double precision, and stored with LatticeMark's bits.
// Bits      Surface values and scalars are rounded in the same way as those of vertices, so cells with a common face
//           agree on whether a ray crosses a surface in this face.
// Ends      A crossing at a segment's back end is a segment of its own, and so is the first of two crossings at its
//           front.

#if defined(TESSERA_PROJECTION_LATTICE_CUT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_CUT_INL_H_
#undef TESSERA_PROJECTION_LATTICE_CUT_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_CUT_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/lattice/lattice_crossed-inl.h"
#include "projection/lattice/lattice_normals-inl.h"
#include "projection/lattice/segment_lanes-inl.h"
#include "projection/surface_crossings.hpp"
#include "scene/lanes/doubles-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Cuts segments of a batch, after find_surfaces() and find_normals(). Appends the part before each crossing, or the
/// crossing itself (surface_crossings.hpp). The last part of a segment stays at the index of the segment.
class SurfaceCuts {
 public:
  HWY_INLINE SurfaceCuts(const LatticeView& view, const LatticeSurfaces& surfaces, const MaskedRect& pixels,
                         SegmentStream& out)
      : perspective_(view.perspective),
        set_(*view.projected.iso->surfaces),
        cells_(surfaces),
        numbers_a_place_(static_cast<std::int32_t>(2 * set_.iso_values().size() + set_.faces())),
        rays_(*view.projected.iso->space, pixels.square_x(), pixels.square_y()),
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
  /// The parts of the segments that are not cut yet: where they begin, and their front scalar or mark.
  struct Part {
    VI front;
    VF scalar;
  };

  HWY_INLINE void cut_lanes(VI segment, MI here) {
    const DI d;
    const DF df;
    const VI hit = GatherIndex(d, out_.hit.data(), segment);
    const VI cell = And(hit, Set(d, static_cast<std::int32_t>(LatticeSurfaces::most_cells) - 1));
    const VI front = GatherIndex(d, out_.front.data(), segment), back = GatherIndex(d, out_.back.data(), segment);
    const VF from = GatherIndex(df, out_.scalar_front.data(), segment),
             to = GatherIndex(df, out_.scalar_back.data(), segment);
    const VI pixel = GatherIndex(d, out_.pixel.data(), segment);
    VF own = Zero(df), white = own;
    if (out_.lit) own = GatherIndex(df, out_.own.data(), segment), white = GatherIndex(df, out_.white.data(), segment);
    const VI first = lookup_16(cells_.first, cell);
    const VI count = IfThenElseZero(here, lookup_16(cells_.count, cell));
    const auto most = static_cast<std::size_t>(GetLane(MaxOfLanes(d, count)));
    // Each crossing appends one segment.
    if (out_.size + most * lanes > out_.front.size() - SegmentStream::padding)
      out_.reserve(2 * (out_.size + most * lanes));

    const MI rises = RebindMask(d, from < to);
    const VI cosine = cosine_code(hit, cell);
    const Doubles steps = promote(back - front), start = promote(front), scalar = promote(from);
    const Doubles slope = steps / (promote(to) - scalar);
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
      const auto depth_at = [](VD along, VD length, VD z)
                                HWY_ATTR { return Round(z + Min(Max(along, Zero(DD())), length)); };
      VI depth = in_integers(in_halves(depth_at, (promote(value) - scalar) * slope, steps, start));
      const MI at_back = Not(depth < limit);
      const VI at =
          IfThenElse(at_back, at_limit, IfThenElse(depth == front, place(Place::front_end), place(Place::inside)));
      depth = Min(depth, limit);
      const VF mark = mark_of(surface, rises, at, cosine);
      // A crossing at the back end is a segment of its own, and so is the first of two crossings at the front.
      const MI alone = And(crossed, Or(at == place(Place::back_end), level));
      const MI before = AndNot(alone, crossed);
      const MI at_front = And(before, depth == part.front);
      const MI marked = RebindMask(d, part.scalar >= Set(df, LatticeMark::first));
      const MI parts = Or(alone, AndNot(AndNot(marked, at_front), before));
      const VI begin = IfThenElse(alone, depth, part.front);
      const VF begin_scalar = IfThenElse(RebindMask(df, alone), mark, part.scalar);
      if (out_.lit) append_light(RebindMask(df, parts), own, white, out_);
      append(RebindMask(df, parts), pixel, {begin, depth, begin_scalar, value}, out_);
      part.front = IfThenElse(before, depth, part.front);
      part.scalar = IfThenElse(RebindMask(df, before), mark, part.scalar);
    }
    // Lanes that have no segment write after the last segment.
    const VI spare = Iota(d, 0) + Set(d, static_cast<std::int32_t>(out_.size));
    const VI place = IfThenElse(here, segment, spare);
    ScatterIndex(part.front, d, out_.front.data(), place);
    ScatterIndex(part.scalar, df, out_.scalar_front.data(), place);
  }

  using Place = scene::SurfaceSet::Place;
  /// Returns the lowest number of a crossing at this place.
  HWY_INLINE VI place(Place p) const { return Set(DI(), static_cast<std::int32_t>(p) * numbers_a_place_); }

  /// Returns the first surfaces that the cells' segments may cross.
  HWY_INLINE VF first_values(MI rises, VI cell) const {
    return IfThenElse(RebindMask(DF(), rises), lookup_16(cells_.low, cell), lookup_16(cells_.high, cell));
  }

  /// Returns the same as LatticeMark::of() for the crossing.
  HWY_INLINE VF mark_of(VI surface, MI rises, VI at, VI cosine) const {
    const DI d;
    const auto n = static_cast<std::int32_t>(set_.iso_values().size());
    const VI within = IfThenElse(rises, surface, Set(d, 2 * n - 1) - surface);
    const VI bits = Or(ShiftLeft<LatticeMark::cosine_bits>(at + within), cosine);
    return BitCast(DF(), bits + Set(d, static_cast<std::int32_t>(LatticeMark::first_bits)));
  }

  /// Returns the lower bits of the lanes' marks.
  HWY_INLINE VI cosine_code(VI hit, VI cell) const {
    const DI d;
    const DF df;
    if (!perspective_) return lookup_16(cells_.cosine_code, cell);
    const VF codes = cosine_of_rays(hit, cell) * Set(df, static_cast<float>(LatticeMark::cosines));
    return ConvertTo(d, codes + Set(df, 0.5f));
  }

  HWY_INLINE VF cosine_of_rays(VI hit, VI cell) const {
    const RayLanes ray(rays_, hit);
    const Doubles &x = ray.x, &y = ray.y, &z = ray.z;
    const Doubles along =
        x * gather(cells_.normal[0], cell) + y * gather(cells_.normal[1], cell) + z * gather(cells_.normal[2], cell);
    const auto cosine = [](VD a, VD square, VD least)
                            HWY_ATTR { return Min(Max(Abs(a) / Sqrt(square), least), Set(DD(), 1)); };
    return demote(in_halves(cosine, along, x * x + y * y + z * z, gather(cells_.least_cosine, cell)));
  }

  bool perspective_;
  const scene::SurfaceSet& set_;
  const LatticeSurfaces& cells_;
  std::int32_t numbers_a_place_;
  SquareRays rays_;
  SegmentStream& out_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
