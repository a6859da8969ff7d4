// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tessera::sorting {

/// Depth order of the windows (projection::SegmentWindows) of a group of neighbouring pixels, one pixel per lane.
/// sort_windows-inl.h computes it: `slots[row * lanes + lane]` is the position of the segment with number `row` in the
/// lane's list, in bytes from the beginning of the list.
struct WindowOrder {
  std::vector<std::int32_t> slots;
  std::vector<float> keys;  ///< working memory of the same size
};

}  // namespace tessera::sorting
