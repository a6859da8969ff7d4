// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "io/mesh/mesh_reader.hpp"
#include "tessera/surfaces.hpp"

namespace tessera::io {

/// Faces in the blocks of a file that are not part of the file's volume.
struct BlockFaces {
  tessera::TriangleMesh mesh;  ///< has values if the blocks have the field; without triangles if there are no faces
  bool has_volume = false;     ///< the blocks also contain volume cells
};

/// Reads the two-dimensional cells of the blocks selected by `read` and cuts them into triangles, higher-order cells by
/// their corners. The values are those of `read.field`; there are none if it is not set or does not exist. Throws
/// Error(bad_input) like read_mesh_blocks, and for a point that is not finite.
BlockFaces read_block_faces(std::span<const InputFile> files, const ReadOptions& read);

}  // namespace tessera::io
