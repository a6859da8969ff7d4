// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// Meshes by Gmsh's library, which is under the GPL: a program of its own, tessera-read-gmsh, links it, and nothing
/// else does. All take `time_step`. A block is a physical group of volumes; cells that are in none are one more.
///
/// Gmsh takes files of no format that it knows for scripts, which may run commands. So it is never given one whose
/// beginning or name is not of the format asked for.

/// MSH 1, 2, 4.0 and 4.1, text and binary, with the views in it as fields.
io::ForeignContents read_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// By their names' extensions alone: Medit (.mesh .meshb), I-DEAS universal (.unv), Nastran bulk data (.bdf .nas).
io::ForeignContents read_by_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

}  // namespace tessera::readers
