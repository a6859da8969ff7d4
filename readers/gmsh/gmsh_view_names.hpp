// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "system/descriptor.hpp"

namespace tessera::readers {

/// Some programs write the names of views without quotes, which Gmsh's library takes for views of no name and mixes up
/// with each other. A copy of such a file in memory, with quotes; closed where the file needs none. Throws
/// Error(system_failure) if there is no memory for it.
system::Descriptor with_quoted_view_names(const std::filesystem::path& file);

/// A copy of a file of MSH 2 whose elements are in no partitions; closed where the file is none. Gmsh's library divides
/// partitioned ones again in its own way, and fails where a mesh has no surfaces. Throws as above.
system::Descriptor without_partitions(const std::filesystem::path& file);

}  // namespace tessera::readers
