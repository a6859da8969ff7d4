// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::apps {

/// `tessera presets`: the names of all colours, a line each; drawn into a picture instead if one is named.
void presets(const std::filesystem::path& picture);

}  // namespace tessera::apps
