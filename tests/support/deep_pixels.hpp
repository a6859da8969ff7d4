// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "scene/deep_image.hpp"

namespace tessera::tests {

/// The result of compositing a pixel's deep samples in front of an opaque plane of `color` at depth z (infinite: no
/// plane), by the rules of "Interpreting OpenEXR Deep Pixels": samples are cut at the plane, as if their density were
/// constant, then composited front to back. Premultiplied RGBA.
inline std::array<double, 4> composited(std::span<const scene::DeepImageSample> samples,
                                        double z = std::numeric_limits<double>::infinity(),
                                        const std::array<double, 3>& color = {0, 0, 0}) {
  std::array<double, 4> sum{};
  const auto over = [&](const std::array<double, 4>& behind) {
    const double through = 1 - sum[3];
    for (int c = 0; c < 4; ++c) sum[c] += through * behind[c];
  };
  for (const scene::DeepImageSample& s : samples) {
    if (s.z >= z) break;
    std::array<double, 4> sample{s.red, s.green, s.blue, s.alpha};
    if (s.z_back > z) {
      const double x = (z - s.z) / (static_cast<double>(s.z_back) - s.z);
      const double alpha = s.alpha, part = -std::expm1(x * std::log1p(-alpha));
      for (int c = 0; c < 3; ++c) sample[c] *= alpha > 0 ? part / alpha : x;
      sample[3] = part;
    }
    over(sample);
  }
  if (std::isfinite(z)) over({color[0], color[1], color[2], 1});
  return sum;
}

}  // namespace tessera::tests
