// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/pixel_rect.hpp"

namespace tessera::volume {

struct TilePlace {
  int x, y;            ///< the first pixel
  std::size_t region;  ///< index of the region whose pixels are rendered
};

/// Returns the tiles that have pixels in the regions, separately for each region. They are sorted along a Z-order
/// curve, so that the bricks that a tile needs are likely to be in the cache from its neighbours.
std::vector<TilePlace> tiles_of(std::span<const scene::PixelRect> regions);

}  // namespace tessera::volume
