// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>

namespace tessera {
inline namespace v0_1 {

/// How a picture is written.
struct ImageFileOptions {
  bool half = false;        ///< .exr: R G B A as half instead of float; Z is float always
  int png_bits = 8;         ///< .png, .tif: 8 or 16 bits a channel
  bool encode_srgb = true;  ///< all but .exr, .pfm: false with display colours, which are display values already
  /// Composited behind the picture, which is opaque then (A = 1; .png without an alpha channel). In the picture's own
  /// space: linear RGB, or display values where encode_srgb is false.
  std::optional<glm::dvec3> background{};
  int jpeg_quality = 92;  ///< .jpg: 1 to 100
  int threads = 0;        ///< .png, .tif, .exr: that compress; 0: all cores. The bytes are the same for any number
};

}  // namespace v0_1
}  // namespace tessera
