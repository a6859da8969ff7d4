// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "io/mesh/mesh_reader.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::io {

/// Faces in a file's blocks that are not part of its volume.
struct BlockFaces {
  tessera::TriangleMesh mesh;  ///< has values if the blocks have the field; has no triangles if there are no faces
  bool has_volume = false;     ///< the blocks also contain volume cells
};

/// The two-dimensional cells of the blocks selected by `read`, cut into triangles; higher-order cells by their corners.
/// Values come from `read.field`, if that is set and exists; otherwise there are none. Throws Error(bad_input) like
/// read_mesh_blocks, and for a point that is not finite.
BlockFaces read_block_faces(std::span<const InputFile> files, const ReadOptions& read);

}  // namespace tessera::io
