// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::apps {

/// `tessera presets`: prints the names of all colours, one per line; draws them into an image instead if one is named.
void presets(const std::filesystem::path& picture);

}  // namespace tessera::apps
