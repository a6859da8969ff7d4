// SPDX-License-Identifier: BSD-3-Clause
// Built instead of image_tiff.cpp if TESSERA_TIFF=OFF.
#include "io/image/image_formats.hpp"
#include "scene/error.hpp"

namespace tessera::io {

bool has_tiff() { return false; }

void write_tiff(const scene::Image& /*image*/, const std::filesystem::path& file, const ImageFileOptions& /*options*/) {
  throw scene::bad_input(file.string() + ": this build leaves .tif out; build with TESSERA_TIFF=ON, or write .png");
}

}  // namespace tessera::io
