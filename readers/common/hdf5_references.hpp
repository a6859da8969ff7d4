// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Where the files to which an HDF5 file refers may be.
enum class ReferencesMay { point_below, point_anywhere };

/// Throws Error(bad_input) unless everything to which an HDF5 file refers (by external links, external storage or
/// sources of virtual datasets, recursively) is in regular files, and no virtual dataset refers back to its own file.
/// Unless the files may be anywhere, they must be in the directory of the file or below. These checks are needed
/// because HDF5's library opens any path, and does not terminate for a cycle. The library itself reports missing files.
/// Does nothing for a file that is not HDF5.
void require_sound_references(const std::filesystem::path& file, ReferencesMay may);

}  // namespace tessera::readers
