// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "io/mesh/mesh_formats.hpp"

/// Meshes of other programs' formats that are in pieces, of which several processes read a share each: an OpenFOAM case
/// as its processors left it (a folder each), the zones of a CGNS file, and a mesh in several Exodus files
/// (NAME.ex2.4.0 to NAME.ex2.4.3).
namespace tessera::io {

/// Whether the file is one, by its name and what it begins with.
bool has_shares(const InputFile& file);

/// The files of a mesh in several Exodus files, by the name of one: NAME.N.0 to NAME.N.(N - 1), their last numbers with
/// as many digits as the named one's. Empty for other files. Throws Error(bad_input) if one is not there.
std::vector<std::filesystem::path> exodus_files(const InputFile& file);

/// Share `part` of `parts`, which may be empty: pieces in their order, each a block or more; all in one share are the
/// whole. Throws Error(bad_input).
cells::MeshBlocks read_share(const InputFile& file, const ReadOptions& options, int part, int parts);

}  // namespace tessera::io
