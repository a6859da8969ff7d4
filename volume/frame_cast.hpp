// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <stop_token>
#include <vector>

#include "scene/pixel_rect.hpp"
#include "volume/fragment_sink.hpp"
#include "volume/frame_setup.hpp"
#include "volume/precise/voxel_cast.hpp"
#include "volume/split/tile_costs.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

/// Statistics of a cast.
struct FrameWork {
  TileCounts counts;            ///< `again` counts rays that were cast again
  std::vector<TileTime> tiles;  ///< excluding the rays that were cast again
};

/// Casts the rays of the `wanted` pixels through `part` of the volume in one pass, tile by tile; no two of the `wanted`
/// rectangles may share a tile. `sink` receives one fragment for every ray that meets the part; fragments of uncertain
/// rays follow after `in_double` has cast these rays again. After a request on `stop`, throws scene::FrameStopped
/// within a tile of rays. Uses the calling thread's arena.
FrameWork cast_frame(const FrameSetup& setup, const VoxelBox& part, std::span<const scene::PixelRect> wanted,
                     FragmentSink& sink, VoxelCaster& in_double, const std::stop_token& stop);

/// Casts a pilot pass (FrameView::tally) through the tiles of `pixels` that PilotPass selects. `stop` and threads work
/// as in cast_frame().
void cast_pilot(const FrameSetup& setup, const scene::PixelRect& pixels, const PilotPass& pass,
                const std::stop_token& stop);

}  // namespace tessera::volume
