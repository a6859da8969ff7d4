#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "scene/image.hpp"

namespace tessera::compositor {

/// A pixel of a tile while fragments that are final are composited into it, front to back: premultiplied linear RGB,
/// and where it begins to show, in planar depth (world units). Optical depth and transmittance are both kept: 1 - 1e-8
/// would lose its opacity, and exp() of every sum its time.
struct MergedPixel {
  double red = 0, green = 0, blue = 0, transmittance = 1, optical_depth = 0;
  double first_depth = std::numeric_limits<double>::infinity();
  bool open = true;  ///< false: what lies behind would not show
};

/// The picture of a tile of that size, row by row.
inline scene::Image image_of(const std::vector<MergedPixel>& pixels, scene::ImageSize size) {
  scene::Image image(size);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const MergedPixel& pixel = pixels[i];
    image.rgba[4 * i + 0] = static_cast<float>(pixel.red);
    image.rgba[4 * i + 1] = static_cast<float>(pixel.green);
    image.rgba[4 * i + 2] = static_cast<float>(pixel.blue);
    // What transmittance lacks to 1 is right to 1e-13 from here on, at a fraction of the time.
    constexpr double thick = 1e-3;
    image.rgba[4 * i + 3] =
        static_cast<float>(pixel.optical_depth > thick ? 1 - pixel.transmittance : -std::expm1(-pixel.optical_depth));
    image.depth[i] = static_cast<float>(pixel.first_depth);
  }
  return image;
}

}  // namespace tessera::compositor
