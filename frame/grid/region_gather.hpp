// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "exchange/transport.hpp"
#include "frame/grid/volume_frames.hpp"

namespace tessera::frame {

/// Sends the pixels of the part's rectangles to rank 0, with their error bounds if the part has error bounds.
void send_region(exchange::Transport& transport, const VolumePart& part);

/// Gathers all ranks' rectangles on rank 0, one frame after the other. Rectangles that arrive before their frame is
/// gathered are kept until then.
class RegionGather {
 public:
  RegionGather(exchange::Transport& transport, scene::Trace* trace) : transport_(transport), trace_(trace) {}

  /// Adds the parts of the other ranks to this rank's part, and reports their pixels to `watch`.
  FinishedVolumeFrame gather(VolumePart own, scene::FrameWatch& watch);

 private:
  exchange::Message next(std::uint64_t frame);
  void place(const exchange::Message& message, std::uint64_t frame, FinishedVolumeFrame& finished,
             scene::FrameWatch& watch) const;

  exchange::Transport& transport_;
  scene::Trace* trace_;
  std::map<std::uint64_t, std::vector<exchange::Message>> early_;  ///< messages that arrived early, by frame number
};

/// Reports pixels that are final on rank 0 to `watch`. If `watch` throws FrameStopped, the frame stops.
void report_region(scene::FrameWatch& watch, const scene::PixelRect& rect, FinishedVolumeFrame& finished);

}  // namespace tessera::frame
