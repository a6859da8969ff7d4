// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "tessera/camera.hpp"

namespace tessera {
inline namespace v0_1 {

/// A finished image. Row-major, row 0 at the top.
/// `rgba`: 4 floats per pixel, linear RGB premultiplied by A; A = 1 - transmittance.
/// `depth`: planar depth along the view direction of the first visible sample (A > 0), world units; +inf where nothing
/// is visible.
struct Image {
  ImageSize size{0, 0};
  std::vector<float> rgba;
  std::vector<float> depth;

  Image() = default;
  explicit Image(ImageSize s)
      : size(s),
        rgba(4 * static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height), 0.0f),
        depth(static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height),
              std::numeric_limits<float>::infinity()) {}

  /// Index of a pixel in `depth`; multiply by four for `rgba`.
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x);
  }
};

}  // namespace v0_1
}  // namespace tessera
