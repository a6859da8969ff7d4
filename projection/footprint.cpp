// SPDX-License-Identifier: BSD-3-Clause
#include "projection/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::projection {
namespace {

/// Whether all corners are outside of one side of the window, that is, beyond the plane through the eye and this side.
/// `coordinate` is PixelVertex::x or ::y. q = coordinate - side * w is linear in the point, so neither a division nor
/// the sign of w is needed.
bool beyond(const std::array<PixelVertex, 4>& corners, double PixelVertex::*coordinate, double side, double sign) {
  return std::all_of(corners.begin(), corners.end(),
                     [&](const PixelVertex& v) { return sign * (v.*coordinate - side * v.w) > 0; });
}

/// Returns the pixels [first, last) of [low, high) whose centres are in the closed interval, which is widened by more
/// than the rounding errors, including those of lines of sight (edge_sign.hpp).
std::array<int, 2> covered(double least, double most, int low, int high) {
  const double slack = 1e-7, relative = 1e-9;
  // Clamps positions far outside the window, which may be infinite; they stay outside by more than the slack.
  least = std::clamp(least, low - 2.0, high + 2.0);
  most = std::clamp(most, low - 2.0, high + 2.0);
  const double first = std::ceil(least - 0.5 - (slack + relative * std::abs(least)));
  const double last = std::floor(most - 0.5 + (slack + relative * std::abs(most))) + 1;
  return {static_cast<int>(std::clamp(first, static_cast<double>(low), static_cast<double>(high))),
          static_cast<int>(std::clamp(last, static_cast<double>(low), static_cast<double>(high)))};
}

}  // namespace

scene::PixelRect footprint(const std::array<PixelVertex, 4>& c, const scene::PixelRect& window) {
  const scene::PixelRect nothing{window.x0, window.y0, window.x0, window.y0};
  if (c[0].w > 0 && c[1].w > 0 && c[2].w > 0 && c[3].w > 0) {
    std::array<double, 4> x, y;
    for (int i = 0; i < 4; ++i) x[i] = c[i].x / c[i].w, y[i] = c[i].y / c[i].w;
    const auto [x_low, x_high] = std::minmax({x[0], x[1], x[2], x[3]});
    const auto [y_low, y_high] = std::minmax({y[0], y[1], y[2], y[3]});
    const auto [x0, x1] = covered(x_low, x_high, window.x0, window.x1);
    const auto [y0, y1] = covered(y_low, y_high, window.y0, window.y1);
    return x0 < x1 && y0 < y1 ? scene::PixelRect{x0, y0, x1, y1} : nothing;
  }
  if (beyond(c, &PixelVertex::x, window.x0, -1) || beyond(c, &PixelVertex::x, window.x1, 1) ||
      beyond(c, &PixelVertex::y, window.y0, -1) || beyond(c, &PixelVertex::y, window.y1, 1))
    return nothing;
  return window;
}

}  // namespace tessera::projection
