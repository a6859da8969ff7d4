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
/// cut into triangles; values are ignored. Throws Error(bad_input, "FILE: ...") if it cannot be read, has no faces, or
/// has faces with holes.
TESSERA_EXPORT TriangleMesh read_triangles(const std::filesystem::path& file);

/// The surface of a block of a mesh's file: a patch of OpenFOAM, a side set or shell block of Exodus, or a block of
/// faces (.vtm) gives its faces; a block of volume (or element set) gives its boundary. `block` as in
/// ReadOptions::blocks; `info` lists some of the names, and the error for an unknown one lists all. Values are those of
/// `options.field` if the block has it, otherwise none. `options.selection` does not cut it. Throws Error(bad_input,
/// "FILE: ...") as Dataset::open.
TESSERA_EXPORT TriangleMesh read_block_surface(std::span<const std::filesystem::path> files, const std::string& block,
                                               const ReadOptions& options = {});

}  // namespace v0_1
}  // namespace tessera
