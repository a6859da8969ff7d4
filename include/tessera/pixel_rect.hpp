// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera {
inline namespace v0_1 {

/// Half-open rectangle of pixels.
struct PixelRect {
  int x0, y0, x1, y1;
  [[nodiscard]] bool empty() const { return x0 >= x1 || y0 >= y1; }
  [[nodiscard]] int width() const { return x1 - x0; }
  [[nodiscard]] int height() const { return y1 - y0; }
  [[nodiscard]] int area() const { return width() * height(); }
};

}  // namespace v0_1
}  // namespace tessera
