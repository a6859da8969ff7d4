// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "io/mesh/mesh_formats.hpp"

/// Meshes of other programs in pieces; each of several processes reads a share: a decomposed OpenFOAM case (one
/// directory per processor), the zones of a CGNS file, and a mesh in several Exodus files (NAME.ex2.4.0 to
/// NAME.ex2.4.3).
namespace tessera::io {

/// Whether the file is one of these, by its name and first bytes.
bool has_shares(const InputFile& file);

/// The files of a mesh in several Exodus files, given the name of one: NAME.N.0 to NAME.N.(N - 1), with as many digits
/// in the last number as in the given name. Empty for other files. Throws Error(bad_input) if one is missing.
std::vector<std::filesystem::path> exodus_files(const InputFile& file);

/// Reads share `part` of `parts`, which may be empty: consecutive pieces, each one or more blocks. A single share is
/// the whole mesh. Throws Error(bad_input).
cells::MeshBlocks read_share(const InputFile& file, const ReadOptions& options, int part, int parts);

}  // namespace tessera::io
