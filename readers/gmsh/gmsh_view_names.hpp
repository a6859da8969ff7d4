// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "system/descriptor.hpp"

namespace tessera::readers {

/// Some programs write view names without quotes. Gmsh's library treats these as views without a name and mixes them
/// up. Returns an in-memory copy of such a file, with quotes; a closed descriptor if the file needs none. Throws
/// Error(system_failure) if memory runs out.
system::Descriptor with_quoted_view_names(const std::filesystem::path& file);

/// A copy of an MSH 2 file whose elements have no partitions; a closed descriptor for other files. Gmsh's library
/// repartitions partitioned elements itself, and fails if a mesh has no surfaces. Throws like the above.
system::Descriptor without_partitions(const std::filesystem::path& file);

}  // namespace tessera::readers
