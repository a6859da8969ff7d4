// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "frame/grid/volume_frames.hpp"
#include "tessera/settings.hpp"

namespace tessera::frame {

/// Renders pictures of volumes with all ranks of `transport` (sort first): each casts the rays of one rectangle through
/// its own renderer of the same volume, rank 0 gathers (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU
/// 2008, 6.3.2). A single rank casts all and splits nothing.
///
/// With Balance::learned rank 0 finds the split from what tiles of the frame before took, where the view is near that
/// frame's (split_by_times.hpp). Else it is found by all ranks together in two stages (volume/split/image_split.hpp):
/// each finds the cost of the rectangle it had in the frame before, of an even tile in the first one. The bits of the
/// picture are those of one process, for any split.
///
/// Rank 0 gets the cost of the whole picture too with FrameSettings::keep_cost, and each pixel's error bound
/// (volume::Renderer::render) with FrameSettings::keep_uncertainty; alike on all ranks.
class SortFirst final : public VolumeFrames {
 public:
  /// Throws Error(bad_input) unless there are no weights or as many positive ones as ranks.
  SortFirst(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame = {});
  ~SortFirst() override;

 private:
  VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                  std::size_t number, scene::FrameWatch& watch) override;

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::frame
