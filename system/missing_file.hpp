// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scene/error.hpp"

namespace tessera::system {

/// The error that a file is not there: it names the file of the same folder that was probably meant, by the names of
/// the folder's first thousand entries.
scene::Error missing_file(const std::filesystem::path& file);

/// "did you mean NAME?", or nothing.
std::string meant_file(const std::filesystem::path& file);

}  // namespace tessera::system
