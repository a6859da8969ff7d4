// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/planes_rasterizer.hpp"

namespace tessera::projection {

/// Working memory of order_by_depth: 12 bytes per entry of the longest list so far. One per thread.
struct DepthOrderScratch {
  std::vector<TileEntry> entries;
  std::vector<std::uint32_t> steps;
};

/// A tile's list in order: `entries` are in the list passed in or in the scratch, and no entry is nearer than a
/// previous one by more than `slack`.
struct DepthOrder {
  std::span<const TileEntry> entries;
  double slack = 0;

  /// No entry from number `from` on is nearer than this.
  [[nodiscard]] double nearest_from(std::size_t from) const { return entries[from].near_depth - slack; }
};

/// Orders a tile's list by near_depth as far as this is worthwhile, in time linear in its length for any depths. The
/// entries may be in any order; there are fewer than 2^32, and no depth is NaN. The list itself is overwritten.
///
/// Depths are quantised between the list's nearest and farthest: one step for every two entries, at most 4096 steps,
/// which one counting pass sorts; entries of one step keep their order. A renderer needs from the order a depth before
/// which no later entry can be, and one step is short compared to the cells whose segments wait for this. If depths
/// crowd into few steps, for example because of a distant outlier, a radix sort orders them completely, in three
/// counting passes.
DepthOrder order_by_depth(std::span<TileEntry> entries, DepthOrderScratch& scratch);

}  // namespace tessera::projection
