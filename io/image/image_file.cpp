// SPDX-License-Identifier: BSD-3-Clause
#include "io/image/image_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <string>

#include "io/image/image_formats.hpp"
#include "scene/error.hpp"
#include "system/atomic_file.hpp"
#include "system/missing_file.hpp"
#include "system/regular_file.hpp"

namespace tessera::io {
namespace {

enum class ImageFormat { exr, png, jpeg, tiff, pfm, unknown };

ImageFormat image_format_of(const std::filesystem::path& file) {
  const std::string extension = system::lower_extension(file);
  if (extension == ".exr") return ImageFormat::exr;
  if (extension == ".png") return ImageFormat::png;
  if (extension == ".jpg" || extension == ".jpeg") return ImageFormat::jpeg;
  if (extension == ".tif" || extension == ".tiff") return ImageFormat::tiff;
  if (extension == ".pfm") return ImageFormat::pfm;
  return ImageFormat::unknown;
}

scene::Error unknown_extension(const std::filesystem::path& file) {
  return scene::bad_input(file.string() +
                          ": does not have the name of an image; end it in .exr, .png, .jpg, .tif or .pfm");
}

}  // namespace

void composited_row(const scene::Image& image, int y, const ImageFileOptions& options,
                    const std::filesystem::path& file, float* rgba) {
  const std::size_t first = image.index(0, y);
  const auto width = static_cast<std::size_t>(image.size.width);
  const float* source = image.rgba.data() + 4 * first;
  const glm::vec3 background(options.background.value_or(glm::dvec3(0)));
  for (std::size_t x = 0; x < width; ++x) {
    const float* in = source + 4 * x;
    float* out = rgba + 4 * x;
    for (int k = 0; k < 4; ++k) {
      if (!std::isfinite(in[k]))
        throw scene::Error(
            scene::ErrorCode::system_failure,
            fmt::format("{}: pixel ({}, {}) was computed as {}; the image was not written, please report this",
                        file.string(), x, y, in[k]));
      out[k] = in[k];
    }
    if (std::isnan(image.depth[first + x]))
      throw scene::Error(
          scene::ErrorCode::system_failure,
          fmt::format("{}: the depth of pixel ({}, {}) is not a number; the image was not written, please report this",
                      file.string(), x, y));
    if (options.background) {
      for (int k = 0; k < 3; ++k) out[k] += (1 - in[3]) * background[k];
      out[3] = 1;
    }
  }
}

namespace {

void check(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  scene::validate(image.size);
  const std::size_t pixels = static_cast<std::size_t>(image.size.width) * static_cast<std::size_t>(image.size.height);
  if (image.rgba.size() != 4 * pixels || image.depth.size() != pixels)
    throw scene::Error(scene::ErrorCode::system_failure,
                       fmt::format("{}: there are {} colours and {} depths for {} pixels; please report this",
                                   file.string(), image.rgba.size(), image.depth.size(), pixels));
  if (options.background)
    for (int k = 0; k < 3; ++k)
      if (!(std::isfinite((*options.background)[k]) && (*options.background)[k] >= 0))
        throw scene::bad_input(
            fmt::format("background {} has a component that is negative or not finite; give three numbers of 0 or more",
                        (*options.background)[k]));
}

}  // namespace

std::vector<std::byte> checked_png_bytes(const scene::Image& image, const ImageFileOptions& options) {
  check(image, "image", options);
  return png_bytes(image, options);
}

std::vector<std::byte> checked_exr_bytes(const scene::Image& image, const ImageFileOptions& options) {
  check(image, "image", options);
  return exr_bytes(image, options);
}

std::vector<std::byte> checked_jpeg_bytes(const scene::Image& image, const ImageFileOptions& options) {
  check(image, "image", options);
  return jpeg_bytes(image, options);
}

void write_image(const scene::Image& image, const std::filesystem::path& file, const ImageFileOptions& options) {
  check(image, file, options);
  switch (image_format_of(file)) {
    case ImageFormat::exr:
      return write_exr(image, file, options);
    case ImageFormat::png:
      return write_png(image, file, options);
    case ImageFormat::jpeg:
      return write_jpeg(image, file, options);
    case ImageFormat::tiff:
      return write_tiff(image, file, options);
    case ImageFormat::pfm:
      return write_pfm(image, file, options);
    case ImageFormat::unknown:
      throw unknown_extension(file);
  }
}

scene::Image read_image(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw system::missing_file(file);
  if (std::filesystem::is_directory(status))
    throw scene::bad_input(file.string() + ": is a directory; name a file in it");
  try {
    switch (image_format_of(file)) {
      case ImageFormat::exr:
        return read_exr(file);
      case ImageFormat::pfm:
        return read_pfm(file);
      default:
        throw scene::bad_input(file.string() + ": images of this type cannot be read back; give an .exr or a .pfm");
    }
  } catch (const std::bad_alloc&) {
    throw scene::Error(scene::ErrorCode::system_failure, file.string() + ": memory ran out for the image");
  }
}

void check_image_path(const std::filesystem::path& file) {
  if (image_format_of(file) == ImageFormat::unknown) throw unknown_extension(file);
  if (image_format_of(file) == ImageFormat::jpeg && !has_jpeg())
    throw scene::bad_input(file.string() + ": this build leaves .jpg out; build with TESSERA_JPEG=ON, or write .png");
  if (image_format_of(file) == ImageFormat::tiff && !has_tiff())
    throw scene::bad_input(file.string() + ": this build leaves .tif out; build with TESSERA_TIFF=ON, or write .png");
  // Creates a file of this kind and discards it, the only test that is valid for every file system and user.
  system::check_writable(file);
}

}  // namespace tessera::io
