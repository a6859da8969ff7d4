// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace tessera::sorting {

/// Depth order of a group of neighbouring pixels' windows (projection::SegmentWindows), a pixel a lane, as
/// sort_windows-inl.h leaves it: element [row * lanes + lane] of `slots` says where in the lane's list its segment
/// number `row` is, in bytes from the list's beginning.
struct WindowOrder {
  std::vector<std::int32_t> slots;
  std::vector<float> keys;  ///< working memory, of the same shape
};

}  // namespace tessera::sorting
