#pragma once

#include <filesystem>

namespace tessera::io {

/// Whether the name is that of a regular or rectilinear grid (.vti .pvti .vtr .pvtr .mhd .mha .nrrd .nhdr .nii .raw
/// .bricks, with or without .gz behind it; upper or lower case), which is rendered as a volume. Does not look at the
/// file. A legacy .vtk may hold one too; read_mesh says so.
bool is_volume_file(const std::filesystem::path& file);

}  // namespace tessera::io
