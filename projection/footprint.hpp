// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "projection/pixel_space.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::projection {

/// The pixels inside `window` whose centres a cell may cover: its bounding box in the image, never too few. Empty if
/// there are none. A cell that crosses the eye plane or is behind it (some w <= 0) has no bounding box: it gets the
/// whole window, or nothing if a plane through the eye and a side of the window separates it from the window.
scene::PixelRect footprint(const std::array<PixelVertex, 4>& corners, const scene::PixelRect& window);

}  // namespace tessera::projection
