// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::apps {

/// Implements `tessera presets`: prints the names of all colours, one per line, or draws the colours into the image
/// file `picture`, if given.
void presets(const std::filesystem::path& picture);

}  // namespace tessera::apps
