// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "frame/grid/volume_frames.hpp"
#include "tessera/settings.hpp"

namespace tessera::frame {

/// Renders frames of volumes with all ranks of `transport` (sort first): each casts the rays of one rectangle through
/// its own renderer of the same volume, and rank 0 gathers the rectangles (Moloney, "Ray Coherence in Parallel Volume
/// Rendering", SFU 2008, 6.3.2). A single rank casts all rays without a split.
///
/// With Balance::learned rank 0 finds the split from the tile times of the last frame, if the view is near that of the
/// last frame (split_by_times.hpp). Otherwise all ranks find it together in two stages (volume/split/image_split.hpp):
/// each computes the cost of its rectangle in the last frame, or of an even tile in the first frame. The bits of the
/// image are those of one process, for any split.
///
/// Rank 0 also gets the cost of the whole image with FrameSettings::keep_cost, and each pixel's error bound
/// (volume::Renderer::render) with FrameSettings::keep_uncertainty. Both must be the same on all ranks.
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
