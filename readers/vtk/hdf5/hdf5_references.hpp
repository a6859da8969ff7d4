// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace tessera::readers {

/// Where the files may be that an HDF5 file leads to.
enum class ReferencesMay { lie_below, lie_anywhere };

/// Throws Error(bad_input) unless what an HDF5 file leads to (external links, external storage, sources of virtual
/// datasets; and what those lead to) is in regular files, which lie beside it or below unless they may lie anywhere,
/// and no virtual dataset leads back to its own file's: HDF5's library opens whatever it is told to, and does not end.
/// A file that is not there is left to the library. Nothing happens to what is not HDF5.
void require_sound_references(const std::filesystem::path& file, ReferencesMay may);

}  // namespace tessera::readers
