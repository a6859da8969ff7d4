// SPDX-License-Identifier: BSD-3-Clause
// Built instead of image_jpeg.cpp if TESSERA_JPEG=OFF.
#include "io/image/image_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {

bool has_jpeg() { return false; }

void write_jpeg(const scene::Image& /*image*/, const std::filesystem::path& file, const ImageFileOptions& /*options*/) {
  throw scene::bad_input(file.string() + ": this build leaves .jpg out; build with TESSERA_JPEG=ON, or write .png");
}

std::vector<std::byte> jpeg_bytes(const scene::Image& /*image*/, const ImageFileOptions& /*options*/) {
  throw scene::bad_input("image: this build leaves .jpg out; build with TESSERA_JPEG=ON, or use .png");
}

}  // namespace tessera::io
