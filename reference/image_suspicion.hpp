// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "reference/suspicion.hpp"
#include "scene/image.hpp"

namespace tessera::reference {

/// What a picture alone says of where it may be wrong. Scores are differences in linear RGBA; a pixel that is not
/// finite has a score beyond all others.
struct ImageSuspicion {
  SuspicionMap edge;     ///< largest difference to one of the eight neighbours
  SuspicionMap outlier;  ///< misfit over that of the pixels around, more where it is a single pixel's: see Suspicion
  SuspicionMap block;  ///< jump across the border of its 4x4 block (second largest of four sides), at one of 16 pixels
  SuspicionMap plateau;  ///< number of pixels in the middle of 3x3 of its very colour, at one of them for each colour
};

/// `least`: differences that do not matter. `threads` 0: all cores.
ImageSuspicion suspect(const scene::Image& image, double least, int threads = 0);

}  // namespace tessera::reference
