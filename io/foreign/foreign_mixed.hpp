// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "io/foreign/client/foreign_file.hpp"
#include "io/mesh/mesh_formats.hpp"
#include "io/volume/volume_reader.hpp"

/// What the helper programs read, as meshes and as volumes; the files of some formats are one or the other by what is
/// in them, which their libraries alone can tell.
namespace tessera::io {

/// A program under readers/, the name of a reader in it, and what to do where it crashes.
struct ForeignReader {
  const char* reader;
  HelperTask task{};
};

/// Whether the file holds one regular or rectilinear grid, so that it is a volume: the helper looks at its header.
/// False too if it cannot be read: opening it then says why.
bool holds_one_grid(const std::filesystem::path& file, const ForeignReader& by);

/// As a volume. Throws Error(bad_input) for a mesh.
VolumeFile read_foreign_volume(const std::filesystem::path& file, const ForeignReader& by,
                               const VolumeOptions& options);

/// As a mesh: all blocks, all arrays, one time step, by default the last; grids as `grids` says.
cells::MeshBlocks read_foreign_mesh(const std::filesystem::path& file, const ForeignReader& by,
                                    const cells::MeshOptions& options, GridsAre grids);

}  // namespace tessera::io
