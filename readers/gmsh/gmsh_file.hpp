// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// Meshes read by Gmsh's library, which is under the GPL: only a separate program, tessera-read-gmsh, links it. All
/// readers support `time_step`. A block is a physical group of volumes; cells without a group form one more block.
///
/// Gmsh executes files of unknown formats as scripts, which may run commands. So Gmsh is called only for files whose
/// beginning or name is that of the expected format.

/// Reads MSH 1, 2, 4.0 and 4.1, text and binary; the views in the file become fields.
io::ForeignContents read_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads formats that the extension alone identifies: Medit (.mesh .meshb), I-DEAS universal (.unv), Nastran bulk data
/// (.bdf .nas).
io::ForeignContents read_by_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

}  // namespace tessera::readers
