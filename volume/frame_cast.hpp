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

/// What a frame's rays took.
struct FrameWork {
  TileCounts counts;            ///< `again` of the rays were cast again
  std::vector<TileTime> tiles;  ///< without the rays that were cast again
};

/// Casts the rays of the pixels `wanted` through `part` of the volume in one pass, tile by tile; no two of these
/// rectangles share a tile. Every ray that meets the part comes to `sink` as one fragment; uncertain ones after
/// `in_double` has cast them again. Throws scene::FrameStopped once `stop` is asked for, within a tile of rays. Uses
/// the calling thread's arena.
FrameWork cast_frame(const FrameSetup& setup, const VoxelBox& part, std::span<const scene::PixelRect> wanted,
                     FragmentSink& sink, VoxelCaster& in_double, const std::stop_token& stop);

/// A pilot pass (FrameView::tally) through the tiles of `pixels` whose turn it is. Stops and threads as cast_frame().
void cast_pilot(const FrameSetup& setup, const scene::PixelRect& pixels, const PilotPass& pass,
                const std::stop_token& stop);

}  // namespace tessera::volume
