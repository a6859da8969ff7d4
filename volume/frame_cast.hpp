#pragma once

#include <stop_token>

#include "scene/pixel_rect.hpp"
#include "volume/fragment_sink.hpp"
#include "volume/frame_setup.hpp"
#include "volume/voxel_box.hpp"
#include "volume/voxel_cast.hpp"

namespace tessera::volume {

/// Casts the rays of the pixels `wanted` through `part` of the volume in one go, tile by tile: a picture, the default
/// way, where that is all of it. Every ray that meets the part comes to `sink` as one fragment; those that float lanes
/// are not sure of after `in_double` has cast them again. A pilot pass needs neither, and casts the tiles of `turns`.
/// Throws scene::FrameStopped once `stop` is asked for, within a tile of rays. Uses the calling thread's arena.
///
/// Gives what it counted; TileCounts::again of rays were cast again.
TileCounts cast_frame(const FrameSetup& setup, const VoxelBox& part, const scene::PixelRect& wanted, FragmentSink* sink,
                      VoxelCaster* in_double, const std::stop_token& stop, PilotTurns turns = {});

}  // namespace tessera::volume
