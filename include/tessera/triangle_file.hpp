#pragma once

#include <filesystem>

#include "tessera/export.hpp"
#include "tessera/surfaces.hpp"

namespace tessera {

/// The triangles of a surface in a file: .ply, .stl, .vtp, .vtk, .poly or .smesh. It need not be closed. Polygons are
/// cut into triangles; values are left out. Throws Error(bad_input, "FILE: ...") if it cannot be read, has no faces, or
/// faces with holes.
TESSERA_EXPORT TriangleMesh read_triangles(const std::filesystem::path& file);

}  // namespace tessera
