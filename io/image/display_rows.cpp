// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/display_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "colormaps/color_spaces.hpp"
#include "io/image/image_formats.hpp"

namespace tessera::io {
namespace {

/// The smallest linear value of each code, and a table that contains, for equal parts of 0..1, the code at the lower
/// end of each part.
struct Codes {
  static constexpr int parts = 4096;
  std::array<double, 257> begin{};  ///< smallest linear value of each code; entry 256 is above all values
  std::array<std::uint8_t, parts + 1> code{};
};

std::uint8_t by_formula(double linear) {
  return static_cast<std::uint8_t>(std::lround(colormaps::encode_srgb(linear) * 255));
}

/// Bisects the doubles in the order of their bit patterns, which is also the order of their values. The result is
/// exactly that of the formula.
Codes make_codes() {
  Codes codes;
  for (int code = 1; code < 256; ++code) {
    std::uint64_t low = 0, high = std::bit_cast<std::uint64_t>(1.0);
    while (high - low > 1) {
      const std::uint64_t middle = low + (high - low) / 2;
      (by_formula(std::bit_cast<double>(middle)) < code ? low : high) = middle;
    }
    codes.begin[static_cast<std::size_t>(code)] = std::bit_cast<double>(high);
  }
  codes.begin[256] = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < codes.code.size(); ++i) codes.code[i] = by_formula(static_cast<double>(i) / Codes::parts);
  return codes;
}

}  // namespace

std::uint8_t srgb_code(double linear) {
  static const Codes codes = make_codes();
  linear = std::clamp(linear, 0.0, 1.0);
  std::size_t code = codes.code[static_cast<std::size_t>(linear * Codes::parts)];
  while (linear >= codes.begin[code + 1]) ++code;  // at most one step: parts are narrower than a code's interval
  return static_cast<std::uint8_t>(code);
}

DisplayRows::DisplayRows(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options,
                         int channels, Order order)
    : image_(image),
      file_(file),
      options_(options),
      channels_(channels),
      order_(order),
      row_bytes_(static_cast<std::size_t>(image.size.width) *
                 static_cast<std::size_t>(channels * options.png_bits / 8)) {}

template <class Put>
void DisplayRows::encode(const std::vector<float>& rgba, const Put& put) const {
  for (std::size_t i = 0; i < rgba.size(); i += 4) {
    // Straight alpha: colours are those of an opaque pixel. Without alpha the image is composited over black.
    const double alpha = rgba[i + 3], scale = channels_ == 3 ? 1 : alpha > 0 ? 1 / alpha : 0;
    for (std::size_t k = 0; k < 3; ++k) put(std::clamp(rgba[i + k] * scale, 0.0, 1.0), true);
    if (channels_ == 4) put(std::clamp(alpha, 0.0, 1.0), false);
  }
}

void DisplayRows::row(int y, std::vector<float>& rgba, std::uint8_t* out) const {
  rgba.resize(4 * static_cast<std::size_t>(image_.size.width));
  composited_row(image_, y, options_, file_, rgba.data());
  if (options_.png_bits == 8)
    return encode(rgba, [&](double level, bool is_color) {
      *out++ =
          is_color && options_.encode_srgb ? srgb_code(level) : static_cast<std::uint8_t>(std::lround(level * 255));
    });
  encode(rgba, [&](double level, bool is_color) {
    const double display = is_color && options_.encode_srgb ? colormaps::encode_srgb(level) : level;
    const auto code = static_cast<unsigned>(std::lround(display * 65535));
    const auto high = static_cast<std::uint8_t>(code >> 8), low = static_cast<std::uint8_t>(code & 0xff);
    *out++ = order_ == Order::big ? high : low;
    *out++ = order_ == Order::big ? low : high;
  });
}

}  // namespace tessera::io
