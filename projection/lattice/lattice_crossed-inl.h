// SPDX-License-Identifier: BSD-3-Clause
// Finds the segments of a batch that may cross a surface. Included once per instruction set (Highway's include guard
// idiom).
//
// What   Returns the indices, packed, of the segments whose scalars extend from below the highest of their cell's
//        surfaces to the lowest or above; and their cells.
// Ends   The result is a superset: lattice_cut-inl.h compares with each surface's value.

#if defined(TESSERA_PROJECTION_LATTICE_CROSSED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TESSERA_PROJECTION_LATTICE_CROSSED_INL_H_
#undef TESSERA_PROJECTION_LATTICE_CROSSED_INL_H_
#else
#define TESSERA_PROJECTION_LATTICE_CROSSED_INL_H_
#endif

#include <hwy/highway.h>

#include "projection/lattice/lattice_shapes-inl.h"
#include "projection/lattice/lattice_surfaces.hpp"

HWY_BEFORE_NAMESPACE();
#if HWY_TARGET != HWY_SCALAR
namespace tessera::projection {
namespace HWY_NAMESPACE {

/// Indices of `count` segments, followed by padding for a vector of lanes; and the cells of these segments, one bit
/// each.
struct CrossedSegments {
  const std::int32_t* numbers;
  std::size_t count;
  unsigned cells;
};

/// Finds the segments, from index `first` on, whose scalars extend from below the last of their cell's surfaces to the
/// first or above.
HWY_NOINLINE inline CrossedSegments crossed_segments(const SegmentStream& stream, std::size_t first,
                                                     LatticeSurfaces& surfaces) {
  const DI d;
  const DF df;
  std::int32_t* const crossed = surfaces.numbers(stream.size - first);
  std::size_t count = 0;
  VI cells = Zero(d);
  VI number = Iota(d, 0) + Set(d, static_cast<std::int32_t>(first));
  for (std::size_t i = first; i < stream.size; i += lanes) {
    const VI cell =
        And(LoadU(d, stream.hit.data() + i), Set(d, static_cast<std::int32_t>(LatticeSurfaces::most_cells) - 1));
    const VF from = LoadU(df, stream.scalar_front.data() + i), to = LoadU(df, stream.scalar_back.data() + i);
    const auto reaches =
        And(Max(from, to) >= lookup_16(surfaces.low, cell), Min(from, to) < lookup_16(surfaces.high, cell));
    const auto is = And(reaches, FirstN(df, stream.size - i));
    // Packing does without a branch, because the branch would be unpredictable.
    const LanePacker pack(RebindMask(d, is));
    StoreU(pack(number), d, crossed + count);
    count += pack.count();
    number = number + Set(d, lanes);
    cells = Or(cells, IfThenElseZero(RebindMask(d, is), Shl(Set(d, 1), cell)));
  }
  alignas(64) std::int32_t of_lane[lanes];
  Store(cells, d, of_lane);
  unsigned all = 0;
  for (const std::int32_t bits : of_lane) all |= static_cast<unsigned>(bits);
  return {crossed, count, all};
}

}  // namespace HWY_NAMESPACE
}  // namespace tessera::projection
#endif  // HWY_SCALAR
HWY_AFTER_NAMESPACE();

#endif
