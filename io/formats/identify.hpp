// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "io/files/format.hpp"
#include "io/files/input_file.hpp"

namespace tessera::io {

/// The table of formats. A file has the format of the first row that recognizes it.
std::span<const Format> formats();

/// Opens a file once and identifies its format: by its first bytes; for a container (Container) by its name; if neither
/// decides, by its name alone. A directory is an OpenFOAM case, an AMReX plot file or a set of DICOM files. Throws like
/// require_file.
InputFile identify(const std::filesystem::path& file);

/// Identifies a file that does not exist, by its name alone.
InputFile identify_by_name(const std::filesystem::path& file);

}  // namespace tessera::io
