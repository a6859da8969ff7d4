// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/image_file.hpp"

namespace tessera {
inline namespace v0_1 {

// All files appear by rename, whole or not at all.

/// Writes a mesh as tetrahedra with its one scalar: .vtu (double, compressed) or .tets (float32). Throws
/// Error(bad_input) for a grid, a part of a mesh, another extension, or what .tets cannot hold; Error(system_failure)
/// if it cannot be written.
TESSERA_EXPORT void write_mesh(const Dataset& mesh, const std::filesystem::path& file);
/// The same of tets in arrays, which need not become a data set.
TESSERA_EXPORT void write_mesh(const MeshArrays& mesh, const std::filesystem::path& file);
/// Writes a mesh as a .pvtu and `pieces` .vtu files beside it, each tet in one of them, for ranks to read.
TESSERA_EXPORT void write_mesh_pieces(const MeshArrays& mesh, const std::filesystem::path& file, int pieces,
                                      const Partition& partition = {});
/// Before reading: throws Error(bad_input) unless `input`, if any, is a mesh's file, a mesh can be written there, in so
/// many pieces if a number is given, and none of the files would be `input` or one of its own pieces. Names may exist,
/// but not as something that is read.
TESSERA_EXPORT void check_mesh_output(const std::filesystem::path& file, const std::filesystem::path& input,
                                      std::optional<int> pieces = std::nullopt);

/// Writes a grid by its extension, .vti .vtr .nrrd .raw .bricks, some slices at a time, so that it may be larger than
/// memory. `block`: samples a side of a brick file's blocks. Throws Error(bad_input) for a mesh and for what the format
/// cannot say (cell data in .nrrd and .raw, a rectilinear grid in all but .vtr and .bricks, a direction in .raw and
/// .vtr); Error(system_failure) if it cannot be written.
TESSERA_EXPORT void write_grid(const Dataset& grid, const std::filesystem::path& file, int block = 64);
TESSERA_EXPORT void write_grid(const SampleSource& grid, const std::filesystem::path& file, int block = 64);
/// Whether write_grid knows the extension.
TESSERA_EXPORT bool is_grid_output(const std::filesystem::path& file);
/// The type of the samples that write_grid makes: the stored one, or where scale and shift have to be applied float32
/// for up to 16 bits and float32, else float64.
TESSERA_EXPORT SampleType written_type(const Dataset& grid);

}  // namespace v0_1
}  // namespace tessera
