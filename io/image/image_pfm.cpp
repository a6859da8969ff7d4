// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <vector>

#include "io/image/image_formats.hpp"
#include "io/text/text_file.hpp"
#include "scene/byte_order.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"

namespace tessera::io {

static_assert(std::endian::native == std::endian::little, ".pfm is written as memory holds it");

// The format: "PF", width and height, and a scale whose sign gives the byte order (negative: little endian), each
// followed by one white space, then rows of RGB floats from the bottom up. Source: Debevec's HDRShop.

void write_pfm(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  system::AtomicFile target(file);
  target.write(fmt::format("PF\n{} {}\n-1.0\n", image.size.width, image.size.height));
  const auto width = static_cast<std::size_t>(image.size.width);
  std::vector<float> row(4 * width), rgb(3 * width);
  for (int y = image.size.height - 1; y >= 0; --y) {
    composited_row(image, y, options, file, row.data());
    for (std::size_t x = 0; x < width; ++x) std::memcpy(&rgb[3 * x], &row[4 * x], 3 * sizeof(float));
    target.write(rgb.data(), rgb.size() * sizeof(float));
  }
  target.commit();
}

scene::Image read_pfm(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const auto fault = [&](const std::string& what) { return scene::bad_input(file.string() + ": " + what); };
  const auto word = [&] {
    std::string text;
    char c = 0;
    while (text.size() < 40 && stream.get(c) && c != ' ' && c != '\n' && c != '\t' && c != '\r') text += c;
    return text;
  };
  if (const std::string magic = word(); magic != "PF")
    throw fault(fmt::format("begins with {}, not PF; give a colour .pfm", quote(magic)));
  const auto width = parse_number(word()), height = parse_number(word()), scale = parse_number(word());
  if (!width || !height || !scale || *scale == 0 || *width != std::floor(*width) || *height != std::floor(*height) ||
      !(*width >= 1 && *width <= scene::max_image_side) || !(*height >= 1 && *height <= scene::max_image_side))
    throw fault("has a broken header; it is `PF`, width and height, and a scale");
  // Checked before allocating: a header may state more pixels than the file contains.
  const auto expected = static_cast<std::uintmax_t>(*width * *height) * 3 * sizeof(float);
  const auto begin = static_cast<std::uintmax_t>(stream.tellg());
  if (const auto bytes = std::filesystem::file_size(file); bytes != begin + expected)
    throw fault(fmt::format("has {} bytes, but its header requires {}; write the file again", bytes, begin + expected));

  scene::Image image({static_cast<int>(*width), static_cast<int>(*height)});
  std::vector<float> row(3 * static_cast<std::size_t>(*width));
  for (int y = image.size.height - 1; y >= 0; --y) {
    if (!stream.read(reinterpret_cast<char*>(row.data()), static_cast<std::streamsize>(row.size() * sizeof(row[0]))))
      throw scene::Error(scene::ErrorCode::system_failure, file.string() + ": reading failed; check the disk");
    for (std::size_t x = 0; x < row.size() / 3; ++x) {
      float* out = &image.rgba[4 * (image.index(0, y) + x)];
      for (std::size_t k = 0; k < 3; ++k) out[k] = scene::load<float>(&row[3 * x + k], *scale > 0);
      out[3] = 1;
    }
  }
  return image;
}

}  // namespace tessera::io
