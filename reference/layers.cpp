// SPDX-License-Identifier: BSD-3-Clause
#include "reference/layers.hpp"

namespace tessera::reference {

std::vector<Pixel> LayerCuts::pixels(const LayerSum& at_hand) const {
  std::vector<LayerSum> sums = ended_;
  sums.push_back(at_hand);
  sums.resize(count_);
  std::vector<Pixel> pixels;
  for (const LayerSum& sum : sums) {
    Pixel pixel;
    pixel.r = sum.color[0], pixel.g = sum.color[1], pixel.b = sum.color[2];
    pixel.a = -std::expm1(-sum.optical_depth);
    pixel.z = sum.first_visible_depth;
    pixels.push_back(pixel);
  }
  return pixels;
}

}  // namespace tessera::reference
