// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "projection/planes_rasterizer.hpp"

namespace tessera::projection {

/// Working memory of order_by_depth(), one per thread: 12 bytes per entry of the longest list so far.
struct DepthOrderScratch {
  std::vector<TileEntry> entries;
  std::vector<std::uint32_t> steps;
};

/// A tile's list in depth order. `entries` are in the list that was passed, or in the scratch. No entry is nearer than
/// a previous entry by more than `slack`.
struct DepthOrder {
  std::span<const TileEntry> entries;
  double slack = 0;

  /// Returns a depth such that no entry from number `from` on is nearer.
  [[nodiscard]] double nearest_from(std::size_t from) const { return entries[from].near_depth - slack; }
};

/// Sorts a tile's list by near_depth as far as this is worthwhile. The time is linear in the length of the list, for
/// any depths. The entries may be in any order; there must be fewer than 2^32, and no depth may be NaN. The list itself
/// is overwritten.
///
/// The range between the list's nearest and farthest depth is divided into steps: one step for every two entries, at
/// most 4096 steps. One counting pass sorts the entries by step; entries of one step keep their order. This order
/// suffices: a renderer only needs a lower bound of the depths of all later entries, and a step is short compared to
/// the cells whose segments wait for this bound. If many depths are in few steps, for example because of a distant
/// outlier, a radix sort sorts them completely, in three counting passes.
DepthOrder order_by_depth(std::span<TileEntry> entries, DepthOrderScratch& scratch);

}  // namespace tessera::projection
