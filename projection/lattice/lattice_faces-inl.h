// SPDX-License-Identifier: BSD-3-Clause
// Cuts segments where their rays meet triangle surfaces, one segment per lane. Included once per instruction set
// (Highway's include guard idiom).
//
// What      Marks of the segment's ray that are inside the segment divide it into parts, from mark to mark. A part's
//           scalars at a mark at depth z are s_0 + (z - z_0) (s_1 - s_0) / (z_1 - z_0).
// How       If a mark is inside a segment, but not further from its front than the depth of a face may be inaccurate,
//           the segment begins at the mark; in the same way, it ends at a mark near its back. So no matter is on the
//           wrong side of a surface that coincides with faces of cells.
// Accuracy  Scalars are computed in double precision. A scalar at a mark is less than the scalar of the higher end, so
//           that a part below a step of the transfer function keeps an end below the step.
// Bits      The parts depend only on the segment and the marks of its ray, which all processes have.
// Ends      Parts before the last one are appended; the last part stays at the index of the segment.

#if defined(TESSERA_PROJECTION_LATTICE_FACES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_FACES_INL_H_
#undef TESSERA_PROJECTION_LATTICE_FACES_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_FACES_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/lattice/lattice_faces.hpp"
#include "projection/lattice/segment_lanes-inl.h"
#include "scene/lanes/doubles-inl.h"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Cuts a stream's segments at the marks of their rays.
class FaceCuts {
 public:
  HWY_INLINE FaceCuts(const LatticeFaces& faces, SegmentStream& out) : faces_(faces), out_(out) {}

  /// Cuts the segments from index `first` on.
  HWY_NOINLINE void cut(std::size_t first) {
    const DI d;
    const std::size_t end = out_.size;
    for (std::size_t i = first; i < end; i += lanes) {
      const auto here = FirstN(d, end - i);
      const VI pixel = IfThenElseZero(here, LoadU(d, out_.pixel.data() + i));
      const VI mark = GatherIndex(d, faces_.begin(), pixel);
      const VI count = IfThenElseZero(here, GatherIndex(d, faces_.begin() + 1, pixel) - mark);
      if (!AllFalse(d, has_inside(i, mark, count))) cut_lanes(i, here, mark, count);
    }
  }

 private:
  /// A segment, one per lane.
  struct Line {
    VI front, back;
    VF from, to;

    /// Returns the scalar at a depth between the segment's ends.
    HWY_INLINE VF scalar_at(VI depth) const {
      const DF d;
      const Doubles steps = promote(back - front), along = promote(depth - front), start = promote(from);
      const VF low = Min(from, to), high = Max(from, to);
      const VF between = Min(Max(demote(start + along * ((promote(to) - start) / steps)), low), high);
      const VF below = Max(low, Min(high - Set(d, 1), high - Abs(high) * Set(d, 0x1p-23f)));
      return IfThenElse(between == high, below, between);
    }
  };

  /// Returns the lanes whose segment has a mark inside.
  HWY_INLINE MI has_inside(std::size_t i, VI mark, VI count) const {
    const DI d;
    const VI front = LoadU(d, out_.front.data() + i), back = LoadU(d, out_.back.data() + i);
    MI has = FirstN(d, 0), left = count > Zero(d);
    for (VI k = Zero(d); !AllFalse(d, left);) {
      const VI place = GatherIndex(d, faces_.places(), IfThenElseZero(left, mark + k));
      has = Or(has, And(left, And(place > front, place < back)));
      k = k + Set(d, 1);
      left = And(left, And(k < count, place < back));
    }
    return has;
  }

  /// Cuts the segments [i, i + lanes) of the mask `here`. `mark` is the index of the first mark of each lane's ray,
  /// and `count` the number of its marks.
  HWY_INLINE void cut_lanes(std::size_t i, MI here, VI mark, VI count) {
    const DI d;
    const DF df;
    const auto most = static_cast<std::size_t>(GetLane(MaxOfLanes(d, count)));
    if (out_.size + most * lanes > out_.front.size() - SegmentStream::padding)
      out_.reserve(2 * (out_.size + most * lanes));
    const VI pixel = LoadU(d, out_.pixel.data() + i), reach = Set(d, LatticeFaces::reach);
    const Line line{LoadU(d, out_.front.data() + i), LoadU(d, out_.back.data() + i),
                    LoadU(df, out_.scalar_front.data() + i), LoadU(df, out_.scalar_back.data() + i)};
    // The part that is not cut yet.
    VI begin = line.front, end = line.back;
    VF scalar = line.from;
    MI left = here;  // lanes that may have further marks inside
    for (std::size_t k = 0; k < most; ++k) {
      const VI kth = Set(d, static_cast<std::int32_t>(k));
      left = And(left, kth < count);
      if (AllFalse(d, left)) break;
      const VI place = GatherIndex(d, faces_.places(), IfThenElseZero(left, mark + kth));
      left = And(left, place < line.back);
      const MI inside = And(left, place > begin), at_front = And(inside, Not(place - line.front > reach));
      const MI at_back = AndNot(at_front, And(inside, Not(line.back - place > reach)));
      end = IfThenElse(at_back, place, end);
      left = AndNot(at_back, left);
      const MI cut = AndNot(Or(at_front, at_back), inside);
      if (!AllFalse(d, cut)) {
        const VF value = line.scalar_at(place);
        if (out_.lit)
          append_light(RebindMask(df, cut), LoadU(df, out_.own.data() + i), LoadU(df, out_.white.data() + i), out_);
        append(RebindMask(df, cut), pixel, {begin, place, scalar, value}, out_);
        scalar = IfThenElse(RebindMask(df, cut), value, scalar);
      }
      begin = IfThenElse(Or(at_front, cut), place, begin);
    }
    BlendedStore(begin, here, d, out_.front.data() + i);
    BlendedStore(end, here, d, out_.back.data() + i);
    BlendedStore(scalar, RebindMask(df, here), df, out_.scalar_front.data() + i);
  }

  const LatticeFaces& faces_;
  SegmentStream& out_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
