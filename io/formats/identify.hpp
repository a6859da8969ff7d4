// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "io/files/format.hpp"
#include "io/files/input_file.hpp"

namespace tessera::io {

/// The one table of formats. A file is of the first that recognizes it.
std::span<const Format> formats();

/// Opens a file once and finds what it is: by what it begins with; files of a container (Container) by their name;
/// where neither tells anything, by its name. A folder is an OpenFOAM case, an AMReX plot file, or of DICOM files.
/// Throws as require_file.
InputFile identify(const std::filesystem::path& file);

/// By its name alone, a file that is not there.
InputFile identify_by_name(const std::filesystem::path& file);

}  // namespace tessera::io
