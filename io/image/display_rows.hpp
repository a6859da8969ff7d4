// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/image/image_file.hpp"

namespace tessera::io {

/// Rows of an image as integers of display values, as written to .png, .jpg, .tif and films: straight alpha,
/// sRGB-encoded if `options` selects that, composited over the background. Callable from any thread.
class DisplayRows {
 public:
  enum class Order : std::uint8_t { little, big };  ///< byte order of 16-bit values

  /// Keeps references to `image`, `file` and `options`; errors name `file`. With four channels the last is alpha. With
  /// three channels there should be a background; otherwise the image is composited over black, as in .pfm.
  DisplayRows(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options,
              int channels, Order order = Order::big);

  [[nodiscard]] std::size_t row_bytes() const { return row_bytes_; }

  /// Writes row `y`, row_bytes() bytes, to `out`. `rgba` is scratch memory that is reused. Throws like
  /// composited_row().
  void row(int y, std::vector<float>& rgba, std::uint8_t* out) const;

 private:
  template <class Put>
  void encode(const std::vector<float>& rgba, const Put& put) const;

  const scene::Image& image_;
  const std::filesystem::path& file_;
  const ImageFileOptions& options_;
  int channels_;
  Order order_;
  std::size_t row_bytes_;
};

/// Returns the integer 0..255 that displays linear light, clamped to 0..1: lround(255 encode_srgb(linear)), computed
/// without a power function.
std::uint8_t srgb_code(double linear);

}  // namespace tessera::io
