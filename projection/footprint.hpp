// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "projection/pixel_space.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::projection {

/// Pixels inside `window` whose centres a cell may cover: never too few, its bounding box in the picture. Empty if
/// there are none. A cell that crosses or lies behind the eye plane (some w <= 0) has no bounding box: it gets the
/// whole window, or nothing if a plane through the eye and a side of the window parts it from the window.
scene::PixelRect footprint(const std::array<PixelVertex, 4>& corners, const scene::PixelRect& window);

}  // namespace tessera::projection
