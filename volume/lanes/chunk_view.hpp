// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "volume/bricks/slab_block.hpp"
#include "volume/frame_view.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {

/// Where a group of rays may be at both ends of a chunk: bounds of (x, y), voxels. The rays being straight, bounds in
/// between are straight, too.
struct Reach {
  float x_low[2], x_high[2], y_low[2], y_high[2];
  bool any;
};

/// What a chunk's slabs share.
struct ChunkView {
  const FrameView& frame;
  const RayAxes axes;
  const SlabBlock& block;
  const ChunkBox& box;
  const Reach* reach;  ///< by packet
};

// The kernels of one chunk of 32 slabs, on the best instruction set: what each packet that `reach` has gathers in it.
// Three for exact integrals, by how many vectors hold a column of the transfer function's table
// (integrals/integrate_lanes-inl.h), three that they leave frames with surfaces to, and one for steps. They are sources
// of their own because they take long to compile.

void cast_chunk_one_vector(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_chunk_two_vectors(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_chunk_many(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_surfaces_one_vector(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_surfaces_two_vectors(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_surfaces_many(const ChunkView& chunk, TileRays& rays, TileCounts& counts);
void cast_chunk_in_steps(const ChunkView& chunk, TileRays& rays, TileCounts& counts);

/// Of a chunk that shows nothing, whose block is empty: pre-integrated steps that begin in it show nothing either.
void skip_chunk_in_steps(const ChunkView& chunk, TileRays& rays);

}  // namespace tessera::volume
