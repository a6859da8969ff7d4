// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "exchange/transport.hpp"
#include "frame/grid/volume_frames.hpp"

namespace tessera::frame {

/// To rank 0: the pixels of the part's rectangle, and their error bounds if it has some.
void send_region(exchange::Transport& transport, const VolumePart& part);

/// On rank 0, all ranks' rectangles of one picture after the other. Those of later pictures wait until theirs is asked
/// for.
class RegionGather {
 public:
  RegionGather(exchange::Transport& transport, scene::Trace* trace) : transport_(transport), trace_(trace) {}

  /// Completes this rank's part by those of the others, whose pixels `watch` hears of.
  FinishedVolumeFrame gather(VolumePart own, scene::FrameWatch& watch);

 private:
  exchange::Message next(std::uint64_t frame);
  void place(const exchange::Message& message, std::uint64_t frame, FinishedVolumeFrame& finished,
             scene::FrameWatch& watch) const;

  exchange::Transport& transport_;
  scene::Trace* trace_;
  std::map<std::uint64_t, std::vector<exchange::Message>> early_;  ///< by their frame
};

/// Tells `watch` of pixels that are final on rank 0; what it throws of a stop stops the frame.
void tell(scene::FrameWatch& watch, const scene::PixelRect& rect, FinishedVolumeFrame& finished);

}  // namespace tessera::frame
