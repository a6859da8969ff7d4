// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "io/mesh/mesh_reader.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::io {

/// Faces of a file's blocks that are no part of its volume.
struct BlockFaces {
  tessera::TriangleMesh mesh;  ///< with values if the blocks have the field; without triangles if there are no faces
  bool has_volume = false;     ///< there are cells of volume too
};

/// The two-dimensional cells of the blocks that `read` chooses, cut into triangles; of higher order by their corners.
/// Values are of `read.field`, which may be empty or unknown: then there are none. Throws Error(bad_input) as
/// read_mesh_blocks, and for a point that is not finite.
BlockFaces read_block_faces(std::span<const InputFile> files, const ReadOptions& read);

}  // namespace tessera::io
