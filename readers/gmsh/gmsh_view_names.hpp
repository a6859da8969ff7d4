// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "system/descriptor.hpp"

namespace tessera::readers {

/// Returns an in-memory copy of a file whose view names lack quotes, with the quotes added. A closed descriptor if the
/// file does not need that. Some programs write names without quotes; Gmsh's library treats these views as views
/// without a name and confuses them with each other. Throws Error(system_failure) if memory runs out.
system::Descriptor with_quoted_view_names(const std::filesystem::path& file);

/// Returns a copy of an MSH 2 file whose elements have no partitions; a closed descriptor for other files. Needed
/// because Gmsh's library repartitions partitioned elements itself, which fails if a mesh has no surfaces. Throws like
/// with_quoted_view_names().
system::Descriptor without_partitions(const std::filesystem::path& file);

}  // namespace tessera::readers
