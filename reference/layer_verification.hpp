// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reference/layers.hpp"
#include "reference/verification.hpp"
#include "scene/image.hpp"

namespace tessera::reference {

/// The results for the layers of an image.
struct LayerVerification {
  double bound = 0;
  std::vector<Tally> layers;  ///< one per layer, starting at the eye
  bool met = true;            ///< Verification::met() for every layer
};

/// Judges layers in the same pixels as an image of `size` (choose_pixels()), by the same rules: a pixel of a layer is
/// excused if its value is inside the range of this layer over rays within 1/1024 pixel.
LayerVerification verify_layers(std::span<const scene::Image> layers, const LayerReference& reference, const Peel& peel,
                                double bound, std::size_t count, const Suspects& suspects, int threads = 0);

}  // namespace tessera::reference
