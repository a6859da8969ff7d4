// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scene/deep_image.hpp"

namespace tessera::io {

/// Whether a picture of this name is deep: it ends in `.deep.exr` (upper or lower case).
bool is_deep_name(const std::filesystem::path& file);

/// Writes deep OpenEXR scan lines, ZIPS: R G B A Z ZBack, all float, as scene::DeepImage has them. Appears by rename,
/// whole or not at all. Throws Error(bad_input) where the file cannot be made, Error(system_failure) if the disk fails
/// or the image breaks its invariants.
void write_deep_exr(const scene::DeepImage& image, const std::filesystem::path& file);

}  // namespace tessera::io
