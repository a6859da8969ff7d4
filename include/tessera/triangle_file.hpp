// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "tessera/dataset.hpp"
#include "tessera/export.hpp"
#include "tessera/surfaces.hpp"

namespace tessera {
inline namespace v0_1 {

/// The triangles of a surface in a file: .ply, .stl, .vtp, .vtk, .poly or .smesh. It need not be closed. Polygons are
/// cut into triangles; values are left out. Throws Error(bad_input, "FILE: ...") if it cannot be read, has no faces, or
/// faces with holes.
TESSERA_EXPORT TriangleMesh read_triangles(const std::filesystem::path& file);

/// The surface of a block of a mesh's file, as it may lie in the whole: a patch of OpenFOAM, a side set or shell block
/// of Exodus, a block of faces (.vtm) with its faces; a block of volume (or element set) with its boundary. `block` as
/// ReadOptions::blocks, of which `info` and the error for an unknown one list some and all. Values are of
/// `options.field` where the block has it, else there are none. Nothing is cut by `options.selection`. Throws
/// Error(bad_input, "FILE: ...") as Dataset::open.
TESSERA_EXPORT TriangleMesh read_block_surface(std::span<const std::filesystem::path> files, const std::string& block,
                                               const ReadOptions& options = {});

}  // namespace v0_1
}  // namespace tessera
