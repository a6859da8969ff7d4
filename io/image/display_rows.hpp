// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "io/image/image_file.hpp"

namespace tessera::io {

/// Rows of a picture as whole numbers of display values, as .png, .jpg, .tif and films hold them: straight alpha, sRGB
/// by `options`, the background behind it. From any thread.
class DisplayRows {
 public:
  enum class Order : std::uint8_t { little, big };  ///< of the bytes of 16 bits

  /// With four channels the last is alpha; with three there should be a background, or the picture's light stands on
  /// black, as in .pfm. Keeps references to all three. Errors name `file`.
  DisplayRows(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options,
              int channels, Order order = Order::big);

  [[nodiscard]] std::size_t row_bytes() const { return row_bytes_; }

  /// Writes row `y` to row_bytes() bytes; `rgba` is room that is used again. Throws as composited_row().
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

/// The whole number of 0..255 that stands for this display value of linear light, which is clamped to 0..1:
/// lround(255 encode_srgb(linear)), without its power.
std::uint8_t srgb_code(double linear);

}  // namespace tessera::io
