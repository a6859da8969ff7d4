// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "volume/bricks/slab_block.hpp"
#include "volume/frame_view.hpp"
#include "volume/split/voxel_box.hpp"
#include "volume/tile_rays.hpp"
#include "volume/tile_state.hpp"

namespace tessera::volume {

/// The buffers of one thread for casting a tile through a chunk.
struct TileMemory {
  SlabBlock block;
  std::vector<float> row;
};

/// Casts the open rays of a tile through the voxels of `chunk`, 32 slabs at a time, and accumulates their light.
///
/// Order     Chunks must be passed front to back along each ray (boxes_front_to_back()). Parts of rays outside all
///           chunks are treated as empty.
/// Bits      The results are bitwise those of a single chunk if chunks begin and end at multiples of 32 voxels along
///           the ray's main axis and contain all voxels across it. Other chunks give the same light up to rounding,
///           1e-6. Early termination, skipped space and the order of sums depend on frame and chunks alone.
/// Reads     Only bricks that have voxels of the chunk and are visible.
void cast_tile(const FrameView& frame, const VoxelBox& chunk, TileState& tile, TileMemory& memory, TileCounts& counts);

// The kernels, dispatched to the best instruction set; TileState calls the first two.

/// Bit n is set if a ray of the tile has axis code n (RayAxes::of).
unsigned axis_codes_of_tile(const PixelRays& rays, int x0, int y0);
/// Sets the positions of the tile's rays of one axis code; k_in >= k_out for rays of other codes.
void set_up_tile(const FrameView& frame, int x0, int y0, int code, TileRays& rays);

}  // namespace tessera::volume
