// SPDX-License-Identifier: BSD-3-Clause
#include "volume/split/tile_order.hpp"

#include <algorithm>
#include <cstdint>

#include "volume/tile_rays.hpp"

namespace tessera::volume {

std::vector<TilePlace> tiles_of(std::span<const scene::PixelRect> regions) {
  std::vector<TilePlace> tiles;
  const int side = TileRays::side;
  for (std::size_t n = 0; n < regions.size(); ++n)
    for (int y = regions[n].y0 / side * side; y < regions[n].y1; y += side)
      for (int x = regions[n].x0 / side * side; x < regions[n].x1; x += side) tiles.push_back({x, y, n});
  const auto spread = [](std::uint32_t n) {
    std::uint64_t bits = 0;
    for (int b = 0; b < 16; ++b) bits |= static_cast<std::uint64_t>(n >> b & 1) << 2 * b;
    return bits;
  };
  const auto place = [&](const TilePlace& tile) {
    return spread(static_cast<std::uint32_t>(tile.x / side)) | spread(static_cast<std::uint32_t>(tile.y / side)) << 1;
  };
  std::sort(tiles.begin(), tiles.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return tiles;
}

}  // namespace tessera::volume
