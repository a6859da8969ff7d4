#pragma once

#include <utility>
#include <vector>

#include "scene/pixel_rect.hpp"

namespace tessera::volume {

/// The first pixels of the tiles that have some of a region's, along a curve that stays in one place for long, so that
/// neighbours find each other's bricks.
std::vector<std::pair<int, int>> tiles_of(const scene::PixelRect& region);

}  // namespace tessera::volume
