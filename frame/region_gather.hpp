#pragma once

#include "exchange/transport.hpp"
#include "frame/volume_frames.hpp"

namespace tessera::frame {

/// What a rank says of its finished rectangle.
struct RegionHeader {
  std::uint64_t frame;
  scene::PixelRect region;
  GridCounters counters;
  double cpu_seconds, split_cpu_seconds;
  std::uint64_t stopped;  ///< 1: no pixels follow
};
static_assert(sizeof(RegionHeader) == sizeof(GridCounters) + 6 * 8);

/// Tells `watch` of pixels that are final on rank 0; what it throws of a stop stops the frame.
void tell(scene::FrameWatch& watch, const scene::PixelRect& rect, FinishedVolumeFrame& finished);

/// Processor time of all threads of this process so far.
double process_cpu_seconds();

/// To rank 0: the header's pixels of the image, and of `error_bounds` unless that is empty.
void send_region(exchange::Transport& transport, const RegionHeader& header, const scene::Image& image,
                 const std::vector<float>& error_bounds);

/// On rank 0: what it has itself goes into `finished`, with those of the others, whose pixels `watch` hears of; of
/// error bounds if `finished` has those of this rank.
void gather_regions(exchange::Transport& transport, const RegionHeader& own, FinishedVolumeFrame& finished,
                    scene::FrameWatch& watch, scene::Trace* trace);

}  // namespace tessera::frame
