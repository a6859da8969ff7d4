// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <vector>

#include "scene/image.hpp"

namespace tessera::compositor {

/// A pixel of a tile while final fragments are composited into it, front to back: its premultiplied linear RGB, and the
/// planar depth (world units) where it becomes visible.
struct MergedPixel {
  double red = 0, green = 0, blue = 0, opacity = 0;
  double first_depth = std::numeric_limits<double>::infinity();
  bool open = true;  ///< false: segments behind it would not be visible

  /// Adds light and its opacity behind the pixel's present contents.
  void add(double r, double g, double b, double its_opacity) {
    const double weight = 1 - opacity;
    red += weight * r, green += weight * g, blue += weight * b;
    opacity += weight * its_opacity;
  }

  void write(scene::Image& image, std::size_t at) const {
    image.rgba[4 * at + 0] = static_cast<float>(red);
    image.rgba[4 * at + 1] = static_cast<float>(green);
    image.rgba[4 * at + 2] = static_cast<float>(blue);
    image.rgba[4 * at + 3] = static_cast<float>(opacity);
    image.depth[at] = static_cast<float>(first_depth);
  }
};

/// Returns the image of a tile of size `size`; `pixels` are ordered row by row.
inline scene::Image image_of(const std::vector<MergedPixel>& pixels, scene::ImageSize size) {
  scene::Image image(size);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i].write(image, i);
  return image;
}

}  // namespace tessera::compositor
