// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace tessera {
inline namespace v0_1 {

/// How an image is written.
struct ImageFileOptions {
  bool half = false;        ///< .exr: R G B A as half instead of float; Z is always float
  int png_bits = 8;         ///< .png, .tif: 8 or 16 bits a channel
  bool encode_srgb = true;  ///< all but .exr, .pfm: false for images that already have display colours
  /// Composited behind the image, which is then opaque (A = 1; .png without an alpha channel). In the image's own
  /// space: linear RGB, or display values if encode_srgb is false.
  std::optional<glm::dvec3> background{};
  int jpeg_quality = 92;  ///< .jpg: 1 to 100
  int threads = 0;        ///< .png, .tif, .exr: threads that compress; 0: all cores. Does not change the bytes
};

}  // namespace v0_1
}  // namespace tessera
