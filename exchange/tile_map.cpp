// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/tile_map.hpp"

#include <algorithm>
#include <numeric>
#include <random>

namespace tessera::exchange {

TileMap::TileMap(std::size_t tiles, int compositors, std::uint64_t seed)
    : owners_(tiles), tiles_(static_cast<std::size_t>(compositors)) {
  std::mt19937_64 random(seed);
  std::vector<int> order(static_cast<std::size_t>(compositors));
  for (std::size_t first = 0; first < tiles; first += order.size()) {
    std::iota(order.begin(), order.end(), 0);
    // std::shuffle is not used because its result differs between standard libraries, and ranks may run different ones.
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
    for (std::size_t i = 0; i < order.size() && first + i < tiles; ++i) {
      owners_[first + i] = order[i];
      tiles_[static_cast<std::size_t>(order[i])].push_back(static_cast<std::uint32_t>(first + i));
    }
  }
}

}  // namespace tessera::exchange
