// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "volume/bricks/slab_block.hpp"
#include "volume/frame_view.hpp"
#include "volume/split/voxel_box.hpp"
#include "volume/tile_rays.hpp"
#include "volume/tile_state.hpp"

namespace tessera::volume {

/// One thread's memory for what a tile needs of a chunk.
struct TileMemory {
  SlabBlock block;
  std::vector<float> row;
};

/// Takes the open rays of a tile through the voxels of `chunk`, 32 slabs at a time, and adds up what they gather there.
///
/// Order    a ray must come to its chunks front to back (boxes_front_to_back()). Parts of rays that chunks leave out
///          are as if they were empty.
/// Bits     chunks that begin and end at multiples of 32 voxels along the axis that a ray moves along most, and
///          have all voxels across it, give it the bits of one chunk; others the same light to rounding, 1e-6.
///          Early ends, skipped space and order of sums depend on frame and chunks alone.
/// Reads    bricks that hold voxels of the chunk, no others; those that nothing is seen of not even then.
void cast_tile(const FrameView& frame, const VoxelBox& chunk, TileState& tile, TileMemory& memory, TileCounts& counts);

// The kernels, on the best instruction set; TileState calls the first two.

/// Bit n is set if some ray of the tile has axis code n (RayAxes::of).
unsigned axis_codes_of_tile(const PixelRays& rays, int x0, int y0);
/// Where the tile's rays of one axis code are; k_in >= k_out for those of others.
void set_up_tile(const FrameView& frame, int x0, int y0, int code, TileRays& rays);

}  // namespace tessera::volume
