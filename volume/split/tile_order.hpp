// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scene/pixel_rect.hpp"

namespace tessera::volume {

struct TilePlace {
  int x, y;            ///< the first pixel
  std::size_t region;  ///< the one whose pixels are meant
};

/// The tiles that have pixels of regions, of each region by themselves, along a curve that stays in one place for long,
/// so that neighbours find each other's bricks.
std::vector<TilePlace> tiles_of(std::span<const scene::PixelRect> regions);

}  // namespace tessera::volume
