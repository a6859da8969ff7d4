// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "tessera/reference.hpp"

namespace tessera::reference {

using Pixel = tessera::ReferencePixel;
using tessera::PixelIndex;

/// A reference solution for images: the colour of a ray through any point of the image, in double precision.
class RayReference {
 public:
  virtual ~RayReference() = default;

  /// Returns the colour of the ray through pixel coordinates (x, y). Pixel (i, j) has its centre at (i + 0.5, j + 0.5).
  /// Callable from any thread.
  [[nodiscard]] virtual Pixel pixel(double x, double y) const = 0;

  /// Returns the colours of the rays through the centres of `wanted`, in that order. `threads` 0: all cores.
  [[nodiscard]] virtual std::vector<Pixel> pixels(std::span<const PixelIndex> wanted, int threads = 0) const;

  [[nodiscard]] virtual scene::ImageSize size() const = 0;

 protected:
  RayReference() = default;
  RayReference(const RayReference&) = default;
  RayReference& operator=(const RayReference&) = default;
};

/// Returns all pixels of an image, row-major.
std::vector<PixelIndex> all_pixels(scene::ImageSize size);

using tessera::random_pixels;

}  // namespace tessera::reference
