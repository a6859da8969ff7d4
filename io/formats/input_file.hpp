// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "system/regular_file.hpp"

namespace tessera::io {

/// Whether a folder is an OpenFOAM case: system/controlDict or constant/polyMesh in it, or the latter in processor0.
bool is_case_folder(const std::filesystem::path& folder);

/// Whether a folder is an AMReX plot file: it has a Header that begins as theirs do.
bool is_amrex_folder(const std::filesystem::path& folder);

/// Whether a folder stands for a file: an OpenFOAM case, an AMReX plot file, or one with a DICOM file among its first
/// thousand, at most four levels below.
bool is_input_folder(const std::filesystem::path& folder);

/// Throws Error(bad_input) unless `file` is a readable regular file that is neither empty nor a pointer of Git LFS, or
/// a folder that stands for one; returns its bytes' number, of a folder 0.
std::uint64_t require_file(const std::filesystem::path& file);

/// The first bytes of a file, at most `limit`. Throws as require_file.
std::string read_beginning(const std::filesystem::path& file, std::size_t limit);

}  // namespace tessera::io
