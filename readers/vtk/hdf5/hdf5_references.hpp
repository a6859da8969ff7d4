// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Where files referenced by an HDF5 file may be.
enum class ReferencesMay { point_below, point_anywhere };

/// Throws Error(bad_input) unless everything referenced by an HDF5 file (external links, external storage, sources of
/// virtual datasets; and recursively) is in regular files, which are in its directory or below unless they may be
/// anywhere, and no virtual dataset refers back to its own file: HDF5's library opens any path, and does not terminate
/// for a cycle. A missing file is left to the library. Does nothing for a file that is not HDF5.
void require_sound_references(const std::filesystem::path& file, ReferencesMay may);

}  // namespace tessera::readers
