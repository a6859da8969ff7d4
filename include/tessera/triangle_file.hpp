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

/// Reads the triangles of a surface from a file: .ply, .stl, .vtp, .vtk, .poly or .smesh. The surface need not be
/// closed. Polygons are cut into triangles; values are ignored. Throws Error(bad_input) if the file cannot be read, has
/// no faces, or has faces with holes.
TESSERA_EXPORT TriangleMesh read_triangles(const std::filesystem::path& file);

/// Reads the surface of a block in a mesh's file. The surface of a patch of OpenFOAM, a side set or shell block of
/// Exodus, or a block of faces (.vtm) consists of its faces; the surface of a block of cells or an element set is its
/// boundary. `block` is a name as in ReadOptions::blocks. The command `info` lists some of the names, and the error for
/// an unknown name lists all. The surface has values if the block has the field `options.field`. `options.selection`
/// does not cut the surface. Throws the same errors as Dataset::open().
TESSERA_EXPORT TriangleMesh read_block_surface(std::span<const std::filesystem::path> files, const std::string& block,
                                               const ReadOptions& options = {});

}  // namespace v0_1
}  // namespace tessera
