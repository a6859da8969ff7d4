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

/// The tiles that have pixels in the regions, for each region separately, sorted along a Z-order curve so that
/// neighbouring tiles find each other's bricks in the cache.
std::vector<TilePlace> tiles_of(std::span<const scene::PixelRect> regions);

}  // namespace tessera::volume
