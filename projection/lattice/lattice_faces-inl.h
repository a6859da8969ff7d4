// SPDX-License-Identifier: BSD-3-Clause
// Cuts segments where their rays meet triangle surfaces, one segment per lane. Included once per instruction set
// (Highway's include guard idiom).
//
// What      Marks of the segment's ray that are inside the segment divide it into parts, from mark to mark. A part's
//           scalars at a mark at depth z are s_0 + (z - z_0) (s_1 - s_0) / (z_1 - z_0).
// How       A mark that is as near to the segment's front as the depth of a face may be inaccurate counts as in front
//           of the segment, which then begins at the mark; in the same way, a segment ends at a mark near its back. So
//           no matter is on the wrong side of a surface that coincides with faces of cells.
//           A crossing of an iso-surface that is a segment of length zero, as near to marks as that, moves to the first
//           mark of a larger number, or to the last mark; the order of numbers then decides (scene::SurfaceSet).
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
  /// `iso` is null if there are no iso-surfaces.
  HWY_INLINE FaceCuts(const LatticeFaces& faces, const IsoView* iso, SegmentStream& out)
      : faces_(faces), iso_(iso), out_(out) {}

  /// Cuts the segments from index `first` on.
  HWY_NOINLINE void cut(std::size_t first) {
    const DI d;
    const std::size_t end = out_.size;
    for (std::size_t i = first; i < end; i += lanes) {
      const auto here = FirstN(d, end - i);
      const VI pixel = IfThenElseZero(here, LoadU(d, out_.pixel.data() + i));
      const VI mark = GatherIndex(d, faces_.begin(), pixel);
      const VI count = IfThenElseZero(here, GatherIndex(d, faces_.begin() + 1, pixel) - mark);
      if (!AllFalse(d, near_marks(i, mark, count))) cut_lanes(i, here, mark, count);
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

  /// Returns the lanes whose segment has a mark inside or within the largest reach.
  HWY_INLINE MI near_marks(std::size_t i, VI mark, VI count) const {
    const DI d;
    const VI reach = Set(d, faces_.most_reach());
    const VI from = LoadU(d, out_.front.data() + i) - reach, to = LoadU(d, out_.back.data() + i) + reach;
    MI near = FirstN(d, 0), left = count > Zero(d);
    for (VI k = Zero(d); !AllFalse(d, left);) {
      const VI place = GatherIndex(d, faces_.places(), IfThenElseZero(left, mark + k));
      near = Or(near, AndNot(Or(place<from, place> to), left));
      k = k + Set(d, 1);
      left = And(left, And(k < count, Not(place > to)));
    }
    return near;
  }

  /// Cuts the segments [i, i + lanes) of the mask `here`. `mark` is the index of the first mark of each lane's ray,
  /// and `count` the number of its marks.
  HWY_INLINE void cut_lanes(std::size_t i, MI here, VI mark, VI count) {
    const DI d;
    const DF df;
    const auto most = static_cast<std::size_t>(GetLane(MaxOfLanes(d, count)));
    if (out_.size + most * lanes > out_.front.size() - SegmentStream::padding)
      out_.reserve(2 * (out_.size + most * lanes));
    const VI pixel = LoadU(d, out_.pixel.data() + i);
    // The part that is not cut yet.
    VI begin = LoadU(d, out_.front.data() + i), end = LoadU(d, out_.back.data() + i);
    VF scalar = IfThenElseZero(RebindMask(df, here), LoadU(df, out_.scalar_front.data() + i));
    const Line line{begin, end, value_of(scalar), LoadU(df, out_.scalar_back.data() + i)};
    const MI crossing = And(begin == end, RebindMask(d, scalar >= Set(df, LatticeMark::first)));
    const VI number = number_of(scalar);
    MI left = here;  // lanes whose next mark may be at their segment
    for (std::size_t k = 0; k < most; ++k) {
      const VI kth = Set(d, static_cast<std::int32_t>(k));
      left = And(left, kth < count);
      if (AllFalse(d, left)) break;
      const VI index = IfThenElseZero(left, mark + kth);
      const VI place = GatherIndex(d, faces_.places(), index), reach = GatherIndex(d, faces_.reaches(), index);
      const MI at_front = And(left, Not(Abs(place - line.front) > reach));
      begin = IfThenElse(at_front, place, begin);
      const MI follows = GatherIndex(d, faces_.numbers(), index) > number;
      left = AndNot(And(And(crossing, at_front), follows), left);
      const MI behind = AndNot(Or(at_front, crossing), left);
      const MI at_back = And(behind, Not(Abs(place - line.back) > reach));
      end = IfThenElse(at_back, place, end);
      left = AndNot(Or(at_back, And(behind, place > line.back)), left);
      const MI inside = And(And(behind, left), place > begin);
      if (AllFalse(d, inside)) continue;
      const VF value = line.scalar_at(place);
      if (out_.lit)
        append_light(RebindMask(df, inside), LoadU(df, out_.own.data() + i), LoadU(df, out_.white.data() + i), out_);
      append(RebindMask(df, inside), pixel, {begin, place, scalar, value}, out_);
      begin = IfThenElse(inside, place, begin);
      scalar = IfThenElse(RebindMask(df, inside), value, scalar);
    }
    BlendedStore(begin, here, d, out_.front.data() + i);
    BlendedStore(IfThenElse(crossing, begin, Max(begin, end)), here, d, out_.back.data() + i);
    BlendedStore(scalar, RebindMask(df, here), df, out_.scalar_front.data() + i);
  }

  /// Returns the front scalars, with the marks of iso-surfaces replaced by the surfaces' values.
  HWY_INLINE VF value_of(VF scalar) const {
    const DF d;
    const MF is_mark = scalar >= Set(d, LatticeMark::first);
    if (iso_ == nullptr || AllFalse(d, is_mark)) return scalar;
    const VI number = IfThenElseZero(RebindMask(DI(), is_mark), number_of(scalar));
    return IfThenElse(is_mark, GatherIndex(d, iso_->surfaces->on_lattice_by_number().data(), number), scalar);
  }

  const LatticeFaces& faces_;
  const IsoView* iso_;
  SegmentStream& out_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
