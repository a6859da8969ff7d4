// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "projection/pixel_space.hpp"
#include "scene/pixel_rect.hpp"

namespace tessera::projection {

/// Returns the pixels inside `window` whose centres a cell may cover: the cell's bounding box in the image, which is
/// never too small. Empty if there are no such pixels. A cell that crosses the eye plane or is behind it (some w <= 0)
/// has no bounding box. The result is then the whole window, or empty if a plane through the eye and a side of the
/// window separates the cell from the window.
scene::PixelRect footprint(const std::array<PixelVertex, 4>& corners, const scene::PixelRect& window);

}  // namespace tessera::projection
