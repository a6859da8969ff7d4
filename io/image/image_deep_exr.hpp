// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scene/deep_image.hpp"

namespace tessera::io {

/// Whether a file name denotes a deep image: it ends in `.deep.exr` (upper or lower case).
bool is_deep_name(const std::filesystem::path& file);

/// Writes deep OpenEXR scan lines, compressed as ZIPS: R G B A Z ZBack, all float, as in scene::DeepImage. The file
/// appears by rename, completely or not at all. Throws Error(bad_input) if the file cannot be created,
/// Error(system_failure) if a write fails or the image violates its invariants.
void write_deep_exr(const scene::DeepImage& image, const std::filesystem::path& file);

}  // namespace tessera::io
