// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "volume/bricks/slab_block.hpp"
#include "volume/frame_view.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {

/// Bounds of the (x, y) positions of a group of rays at both ends of a chunk, in voxels. As rays are straight, bounds
/// in between are linear.
struct Reach {
  float x_low[2], x_high[2], y_low[2], y_high[2];
  bool any;
};

/// The data shared by a chunk's slabs.
struct ChunkView {
  const FrameView& frame;
  const RayAxes axes;
  const SlabBlock& block;
  const ChunkBox& box;
  const Reach* reach;  ///< one per packet
};

// The kernels of one chunk of 32 slabs, dispatched to the best instruction set. They accumulate the light of every
// packet for which `reach` has any rays. Three kernels compute exact integrals; they differ in the number of vectors in
// which a column of the transfer function's table is stored (integrals/integrate_lanes-inl.h). For frames with
// surfaces, they call three other kernels. One more kernel samples in steps. The kernels are separate sources because
// they take long to compile.

void cast_chunk_one_vector(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_chunk_two_vectors(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_chunk_many(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_surfaces_one_vector(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_surfaces_two_vectors(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_surfaces_many(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_chunk_in_steps(const ChunkView& chunk, TileRays& rays, TileCounts& counts);

/// Called for an invisible chunk, whose block is not filled: pre-integrated steps that begin in the chunk are
/// invisible, too.
void skip_chunk_in_steps(const ChunkView& chunk, TileRays& rays);

}  // namespace tessera::volume
