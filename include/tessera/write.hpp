#pragma once

#include <filesystem>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/image_file.hpp"

namespace tessera {

// All files appear by rename, whole or not at all.

/// Writes a mesh as tetrahedra with its one scalar: .vtu (double, compressed) or .tets (float32). Throws
/// Error(bad_input) for a grid, a part of a mesh, another extension, or what .tets cannot hold; Error(system_failure)
/// if it cannot be written.
TESSERA_EXPORT void write_mesh(const Dataset& mesh, const std::filesystem::path& file);

/// Writes a grid by its extension, .vti .vtr .nrrd .raw .bricks, some slices at a time, so that it may be larger than
/// memory. `block`: samples a side of a brick file's blocks. Throws Error(bad_input) for a mesh and for what the format
/// cannot say (cell data in .nrrd and .raw, a rectilinear grid in all but .vtr and .bricks, a direction in .raw and
/// .vtr); Error(system_failure) if it cannot be written.
TESSERA_EXPORT void write_grid(const Dataset& grid, const std::filesystem::path& file, int block = 64);

}  // namespace tessera
