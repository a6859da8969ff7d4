// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "io/files/format.hpp"
#include "io/files/input_file.hpp"

namespace tessera::io {

/// The table of formats. The format of a file is the first row that recognizes the file.
std::span<const Format> formats();

/// Opens a file once and identifies its format by the first bytes. If these show only a container (Container), the name
/// determines the format; if they show nothing, the name alone decides. A directory is an OpenFOAM case, an AMReX plot
/// file or a set of DICOM files. Throws like require_file.
InputFile identify(const std::filesystem::path& file);

/// Identifies a file that does not exist, by its name alone.
InputFile identify_by_name(const std::filesystem::path& file);

}  // namespace tessera::io
