// SPDX-License-Identifier: BSD-3-Clause
#include "volume/image_sink.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::volume {

void ImageSink::take(std::span<const RayFragment> fragments) {
  for (const RayFragment& fragment : fragments) {
    const std::size_t pixel = image_.index(fragment.x, fragment.y);
    if (error_bounds_ != nullptr) error_bounds_[pixel] = fragment.error_bound;
    float* const rgba = &image_.rgba[4 * pixel];
    rgba[0] = std::max(0.0f, fragment.red), rgba[1] = std::max(0.0f, fragment.green);
    rgba[2] = std::max(0.0f, fragment.blue), rgba[3] = std::min(1.0f, std::max(0.0f, fragment.alpha));
    if (rgba[3] > 0 && !std::isnan(fragment.z_front)) image_.depth[pixel] = fragment.z_front;
  }
}

}  // namespace tessera::volume
