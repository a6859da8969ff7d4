// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/planes_rasterizer.hpp"

namespace tessera::projection {

/// Working memory of order_by_depth: 12 bytes an entry of the longest list so far. One a thread.
struct DepthOrderScratch {
  std::vector<TileEntry> entries;
  std::vector<std::uint32_t> steps;
};

/// A tile's list in order: `entries` lie in the list given or in the scratch, and none is nearer than one before it by
/// more than `slack`.
struct DepthOrder {
  std::span<const TileEntry> entries;
  double slack = 0;

  /// What no entry from number `from` on is nearer than.
  [[nodiscard]] double nearest_from(std::size_t from) const { return entries[from].near_depth - slack; }
};

/// Orders a tile's list by near_depth as far as it pays, in time linear in its length whatever the depths. Entries in
/// any order, fewer than 2^32; no depth is NaN. The list's own order is lost.
///
/// Depths are quantised between the list's nearest and farthest to a step for every second entry, at most 4096, which
/// one counting pass puts in order; entries of one step stay as they were. What a renderer asks of the order is a depth
/// before which nothing comes any more, and one step is short beside the cells whose segments wait for that. Where
/// depths crowd into few steps, as when an outlier far away pushes them there, a radix sort puts them in order for
/// certain, in three counting passes.
DepthOrder order_by_depth(std::span<TileEntry> entries, DepthOrderScratch& scratch);

}  // namespace tessera::projection
