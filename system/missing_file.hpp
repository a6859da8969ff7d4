// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scene/error.hpp"

namespace tessera::system {

/// The error for a missing file: it suggests the file of the same directory that was probably meant, among the first
/// thousand entries.
scene::Error missing_file(const std::filesystem::path& file);

/// "did you mean NAME?", or empty.
std::string meant_file(const std::filesystem::path& file);

}  // namespace tessera::system
