#pragma once

#include <array>
#include <vector>

#include "scene/image.hpp"
#include "volume/frame_view.hpp"
#include "volume/slab_block.hpp"
#include "volume/tile_rays.hpp"

namespace tessera::volume {

/// One thread's memory.
struct TileMemory {
  TileRays rays;
  SlabBlock block;
  std::vector<float> row;
  std::vector<std::array<int, 2>> uncertain;  ///< pixels (x, y) that are to be cast again, in double precision
};

/// Casts the rays of the tile whose first pixel is (x0, y0), multiples of 32, and writes those of its pixels that lie
/// in `region`, or notes them in `uncertain` (lane_error_bound.hpp); a pilot pass (FrameView::tally) casts a few
/// packets and needs no image. Early ends, skipped space and order of sums depend on the frame alone. `error_bounds`,
/// unless null, gets what each of those pixels' rays may err, by the pixel's index in the image.
void cast_tile(const FrameView& frame, int x0, int y0, const scene::PixelRect& region, TileMemory& memory,
               scene::Image* image, TileCounts& counts, float* error_bounds);

}  // namespace tessera::volume
