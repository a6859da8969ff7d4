// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "tessera/pixel_rect.hpp"

namespace tessera::scene {

using tessera::PixelRect;

/// Returns the intersection of two rectangles. If they do not intersect, it is an empty rectangle at a corner of `a`.
inline PixelRect common(const PixelRect& a, const PixelRect& b) {
  const PixelRect both{std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
  return both.empty() ? PixelRect{a.x0, a.y0, a.x0, a.y0} : both;
}

}  // namespace tessera::scene
