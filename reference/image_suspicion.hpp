// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference/suspicion.hpp"
#include "scene/image.hpp"

namespace tessera::reference {

/// Where an image may be wrong, judged from the image alone. Scores are differences in linear RGBA; a pixel that is not
/// finite has a score above all others.
struct ImageSuspicion {
  SuspicionMap edge;     ///< largest difference to one of the eight neighbours
  SuspicionMap outlier;  ///< misfit relative to that of the surrounding pixels (Suspicion::outlier)
  SuspicionMap block;    ///< jump across the sides of the pixel's 4x4 block (second largest), at one of its 16 pixels
  SuspicionMap plateau;  ///< centres of 3x3 pixels of exactly one colour; one pixel is set per colour
};

/// Differences up to `least` are negligible. `threads` 0: all cores.
ImageSuspicion suspect(const scene::Image& image, double least, int threads = 0);

}  // namespace tessera::reference
