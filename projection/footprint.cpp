#include "projection/footprint.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::projection {
namespace {

/// Whether the half space through the eye beyond one side of the window holds all corners. `coordinate` is
/// x or y; q = coordinate - side * w is linear in the point, so no division and no sign of w enters.
bool beyond(const std::array<HomogeneousVertex, 4>& corners, double HomogeneousVertex::*coordinate, double side,
            double sign) {
  return std::all_of(corners.begin(), corners.end(),
                     [&](const HomogeneousVertex& v) { return sign * (v.*coordinate - side * v.w) > 0; });
}

/// Pixels [first, last) of [low, high) whose centres lie in the closed interval, widened by far more than rounding.
std::array<int, 2> covered(double least, double most, int low, int high) {
  const double slack = 1e-9;
  const double first = std::ceil(least - 0.5 - slack * (1 + std::abs(least)));
  const double last = std::floor(most - 0.5 + slack * (1 + std::abs(most))) + 1;
  return {static_cast<int>(std::clamp(first, static_cast<double>(low), static_cast<double>(high))),
          static_cast<int>(std::clamp(last, static_cast<double>(low), static_cast<double>(high)))};
}

}  // namespace

PixelRect footprint(const std::array<PixelVertex, 4>& c, const PixelRect& window) {
  const PixelRect nothing{window.x0, window.y0, window.x0, window.y0};
  if (c[0].w > 0 && c[1].w > 0 && c[2].w > 0 && c[3].w > 0) {
    const auto [x_low, x_high] = std::minmax({c[0].x, c[1].x, c[2].x, c[3].x});
    const auto [y_low, y_high] = std::minmax({c[0].y, c[1].y, c[2].y, c[3].y});
    const auto [x0, x1] = covered(x_low, x_high, window.x0, window.x1);
    const auto [y0, y1] = covered(y_low, y_high, window.y0, window.y1);
    return x0 < x1 && y0 < y1 ? PixelRect{x0, y0, x1, y1} : nothing;
  }
  const std::array h{homogeneous(c[0]), homogeneous(c[1]), homogeneous(c[2]), homogeneous(c[3])};
  if (beyond(h, &HomogeneousVertex::x, window.x0, -1) || beyond(h, &HomogeneousVertex::x, window.x1, 1) ||
      beyond(h, &HomogeneousVertex::y, window.y0, -1) || beyond(h, &HomogeneousVertex::y, window.y1, 1))
    return nothing;
  return window;
}

}  // namespace tessera::projection
