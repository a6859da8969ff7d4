// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/image_file.hpp"

namespace tessera {
inline namespace v0_1 {

// All files are written under a temporary name and then renamed, so that they appear complete or not at all.

/// Writes a mesh as tetrahedra with one scalar: .vtu (double, compressed) or .tets (float32). Throws Error(bad_input)
/// for a grid, a part of a mesh, another extension, or data that .tets cannot represent; Error(system_failure) if it
/// cannot be written.
TESSERA_EXPORT void write_mesh(const Dataset& mesh, const std::filesystem::path& file);
/// Does the same for tets in arrays, without a data set.
TESSERA_EXPORT void write_mesh(const MeshArrays& mesh, const std::filesystem::path& file);
/// Writes a mesh as a .pvtu and `pieces` .vtu files next to it, so that ranks can read separate files. Each tet is in
/// exactly one of the .vtu files.
TESSERA_EXPORT void write_mesh_pieces(const MeshArrays& mesh, const std::filesystem::path& file, int pieces,
                                      const Partition& partition = {});
/// For use before reading: throws Error(bad_input) if `input` is given and is not a mesh's file, if a mesh cannot be
/// written to `file` (in `pieces` pieces, if a number is given), or if one of the written files would replace `input`
/// or one of its pieces. Other existing files are replaced.
TESSERA_EXPORT void check_mesh_output(const std::filesystem::path& file, const InputFile* input,
                                      std::optional<int> pieces = std::nullopt);

/// Writes a grid in the format of the file's extension: .vti .vtr .nrrd .raw .bricks. A few slices are written at a
/// time, so that the grid may be larger than memory. `block` is the number of samples per side of the blocks of a brick
/// file. Throws Error(bad_input) for a mesh and for properties that the format does not support: cell data in .nrrd and
/// .raw, rectilinear grids in all formats but .vtr and .bricks, a direction in .raw and .vtr. Throws
/// Error(system_failure) if the file cannot be written.
TESSERA_EXPORT void write_grid(const Dataset& grid, const std::filesystem::path& file, int block = 64);
TESSERA_EXPORT void write_grid(const SampleSource& grid, const std::filesystem::path& file, int block = 64);
/// Whether write_grid() supports the extension.
TESSERA_EXPORT bool is_grid_output(const std::filesystem::path& file);
/// The type of the samples that write_grid() writes. It is the stored type, unless scale and shift must be applied:
/// then it is float32 for stored float32 and for integers of up to 16 bits, and otherwise float64.
TESSERA_EXPORT SampleType written_type(const Dataset& grid);

}  // namespace v0_1
}  // namespace tessera
