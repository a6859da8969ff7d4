// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "frame/grid/volume_frames.hpp"
#include "tessera/settings.hpp"

namespace tessera::frame {

/// Renders frames of volumes with all ranks of `transport` (sort last). Each rank casts all rays through one box of the
/// volume (volume/split/object_split.hpp) and only ever reads the bricks of this box; volume::RenderSettings::parts
/// passes the number of boxes to its renderer. The images of the boxes are composited front to back by direct send
/// (exchange/direct/direct_send.hpp): each rank composites a band of rows, and rank 0 gathers the bands. Boxes change
/// only with the transfer function.
///
/// A ray ends early only because of matter in its own box, not because of matter in front of it in another box;
/// docs/RESULTS.md, Figure 6.15 shows the cost. Images of different numbers of ranks, or of different brick sizes,
/// differ by rounding; otherwise the bits are always the same. FrameSettings::keep_uncertainty works as in SortFirst.
class SortLast final : public VolumeFrames {
 public:
  SortLast(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame = {});
  ~SortLast() override;

 private:
  VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                  std::size_t number, scene::FrameWatch& watch) override;

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::frame
