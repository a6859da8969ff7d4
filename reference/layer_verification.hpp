// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "reference/layers.hpp"
#include "reference/verification.hpp"
#include "scene/image.hpp"

namespace tessera::reference {

/// What was found in the layers of a picture.
struct LayerVerification {
  double bound = 0;
  std::vector<Tally> layers;  ///< one each, from the eye on
  bool met = true;            ///< as Verification::met() of each
};

/// Judges layers in the pixels that a picture of `size` is judged in (choose_pixels()), by the same rules: a pixel of a
/// layer is excused if its value lies inside the range that this layer has over rays within 1/1024 pixel.
LayerVerification verify_layers(std::span<const scene::Image> layers, const LayerReference& reference, const Peel& peel,
                                double bound, std::size_t count, const Suspects& suspects, int threads = 0);

}  // namespace tessera::reference
