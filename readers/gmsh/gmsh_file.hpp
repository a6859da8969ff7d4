// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "readers/common/holdings.hpp"

namespace tessera::readers {

/// Meshes read by Gmsh's library, which is under the GPL: a separate program, tessera-read-gmsh, links it, and nothing
/// else does. All readers support `time_step`. A block is a physical group of volumes; cells without a group form one
/// more.
///
/// Gmsh treats files of unknown formats as scripts, which may run commands. So it never gets a file unless its
/// beginning or name is that of the expected format.

/// MSH 1, 2, 4.0 and 4.1, text and binary, with their views as fields.
io::ForeignContents read_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// By their extensions alone: Medit (.mesh .meshb), I-DEAS universal (.unv), Nastran bulk data (.bdf .nas).
io::ForeignContents read_by_gmsh(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

}  // namespace tessera::readers
