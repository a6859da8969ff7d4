// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "io/mesh/mesh_formats.hpp"

/// Meshes of other programs that consist of pieces, so that each of several processes can read a share: a decomposed
/// OpenFOAM case (one directory per processor), the zones of a CGNS file, and a mesh in several Exodus files
/// (NAME.ex2.4.0 to NAME.ex2.4.3).
namespace tessera::io {

/// Whether the file is a mesh of this kind, according to its name and first bytes.
bool has_shares(const InputFile& file);

/// Given one file of a mesh in several Exodus files, returns all of them: NAME.N.0 to NAME.N.(N - 1), where the last
/// number has as many digits as in the given name. Empty for other files. Throws Error(bad_input) if one of the files
/// is missing.
std::vector<std::filesystem::path> exodus_files(const InputFile& file);

/// Reads one share of the mesh, number `part` of `parts`. The share may be empty; otherwise it consists of consecutive
/// pieces of one or more blocks each. A single share is the whole mesh. Throws Error(bad_input).
cells::MeshBlocks read_share(const InputFile& file, const ReadOptions& options, int part, int parts);

}  // namespace tessera::io
