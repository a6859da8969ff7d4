#pragma once

#include <array>
#include <optional>

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// Half-open rectangle of pixels.
struct PixelRect {
  int x0, y0, x1, y1;
  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
  [[nodiscard]] int area() const { return width() * height(); }
};

/// Pixels inside `window` whose centres a cell may cover: never too few, its bounding box in the picture. Empty if
/// there are none. A cell that crosses or lies behind the eye plane (some w <= 0) has no bounding box: it gets the
/// whole window, or nothing if a plane through the eye and a side of the window parts it from the window.
PixelRect footprint(const std::array<PixelVertex, 4>& corners, const PixelRect& window);

}  // namespace tessera::projection
