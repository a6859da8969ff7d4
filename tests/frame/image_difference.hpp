// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/image.hpp"

namespace tessera::frame {

/// Returns the largest difference of a channel between two images of the same size.
inline double difference(const scene::Image& a, const scene::Image& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) most = std::max(most, std::fabs(double{a.rgba[i]} - b.rgba[i]));
  return most;
}

}  // namespace tessera::frame
