#include "volume/tile_order.hpp"

#include <algorithm>
#include <cstdint>

#include "volume/tile_rays.hpp"

namespace tessera::volume {

std::vector<std::pair<int, int>> tiles_of(const scene::PixelRect& region) {
  std::vector<std::pair<int, int>> tiles;
  const int side = TileRays::side;
  for (int y = region.y0 / side * side; y < region.y1; y += side)
    for (int x = region.x0 / side * side; x < region.x1; x += side) tiles.emplace_back(x, y);
  const auto spread = [](std::uint32_t n) {
    std::uint64_t bits = 0;
    for (int b = 0; b < 16; ++b) bits |= static_cast<std::uint64_t>(n >> b & 1) << 2 * b;
    return bits;
  };
  const auto place = [&](const std::pair<int, int>& tile) {
    return spread(static_cast<std::uint32_t>(tile.first / side)) |
           spread(static_cast<std::uint32_t>(tile.second / side)) << 1;
  };
  std::sort(tiles.begin(), tiles.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  return tiles;
}

}  // namespace tessera::volume
