// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace tessera {
inline namespace v0_1 {

/// Options for writing an image.
struct ImageFileOptions {
  bool half = false;        ///< .exr: R G B A as half instead of float; Z is always float
  int png_bits = 8;         ///< .png, .tif: 8 or 16 bits per channel
  bool encode_srgb = true;  ///< all formats but .exr and .pfm: whether to convert linear light to sRGB; false for
                            ///< images that already have display colours
  /// Colour composited behind the image, which is then opaque (A = 1; .png without an alpha channel). The colour is
  /// linear RGB or, if encode_srgb is false, consists of display values.
  std::optional<glm::dvec3> background{};
  int jpeg_quality = 92;  ///< .jpg: 1 to 100
  int threads = 0;        ///< .png, .tif, .exr: threads that compress; 0: all cores; the bytes do not depend on it
};

}  // namespace v0_1
}  // namespace tessera
