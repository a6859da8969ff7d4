// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "projection/lattice/segment_windows.hpp"
#include "projection/scanline/segment_tuple.hpp"

namespace tessera::compositor {

/// The paper's 4-tuple, with the pixel to which it belongs.
struct TupleRecord {
  std::uint32_t pixel;
  projection::SegmentTuple tuple;
};
static_assert(sizeof(TupleRecord) == 20);

/// The wire format of these records, which follow a LatticeHeader (exchange/wire.hpp), is this structure byte for byte.
static_assert(sizeof(projection::LatticeSegment) == 16);

}  // namespace tessera::compositor
