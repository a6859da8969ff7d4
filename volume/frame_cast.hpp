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

/// Casts the rays of the pixels `wanted`, rectangles of which no two share a tile, through `part` of the volume in one
/// go, tile by tile: a picture, the default way, where that is all of it. Every ray that meets the part comes to `sink`
/// as one fragment; those that float lanes are not sure of after `in_double` has cast them again. A pilot pass needs
/// neither, and casts the tiles of `turns`. Throws scene::FrameStopped once `stop` is asked for, within a tile of rays.
/// Uses the calling thread's arena.
///
/// Gives what it counted; TileCounts::again of rays were cast again. `times` gets what each tile took, those rays left
/// out.
TileCounts cast_frame(const FrameSetup& setup, const VoxelBox& part, std::span<const scene::PixelRect> wanted,
                      FragmentSink* sink, VoxelCaster* in_double, const std::stop_token& stop, PilotTurns turns = {},
                      std::vector<TileTime>* times = nullptr);

}  // namespace tessera::volume
