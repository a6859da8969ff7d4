// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "frame/grid/volume_frames.hpp"
#include "tessera/settings.hpp"

namespace tessera::frame {

/// Renders pictures of volumes with all ranks of `transport` (sort last): each casts all rays through one box of the
/// volume (volume/split/object_split.hpp), whose bricks alone it ever reads, by a renderer that knows the number of
/// parts (volume::RenderSettings::parts); the boxes' pictures are composited front to back by direct send
/// (exchange/direct/direct_send.hpp), each rank a band of rows, and rank 0 gathers the bands. Boxes change with the
/// transfer function only.
///
/// A ray ends early within a box, not for what lies in front of it in another's: what that costs is
/// docs/RESULTS.md, Figure 6.15. Pictures of other numbers of ranks, or brick sizes, differ by
/// rounding; else the bits are always the same. FrameSettings::keep_uncertainty as SortFirst's.
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
