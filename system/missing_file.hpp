// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scene/error.hpp"

namespace tessera::system {

/// Returns the error for a missing file. It suggests the file that was probably meant, out of the first thousand
/// entries of the same directory.
scene::Error missing_file(const std::filesystem::path& file);

/// Returns "did you mean NAME?", or an empty text.
std::string meant_file(const std::filesystem::path& file);

}  // namespace tessera::system
