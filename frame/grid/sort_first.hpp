// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "frame/grid/volume_frames.hpp"
#include "tessera/settings.hpp"

namespace tessera::frame {

/// Renders frames of volumes with all ranks of `transport` (sort first). Each rank casts the rays of one rectangle
/// through its own renderer of the same volume, and rank 0 gathers the rectangles (Moloney, "Ray Coherence in Parallel
/// Volume Rendering", SFU 2008, 6.3.2). A single rank casts all rays without a split.
///
/// With Balance::learned, rank 0 computes the split from the tile times of the last frame if the view is close to the
/// last view (split_by_times.hpp). Otherwise all ranks compute the split together in two stages
/// (volume/split/image_split.hpp): each rank computes the cost of the rectangle that it had in the last frame, or, in
/// the first frame, of one rectangle of an even split. The image has the same bits as that of one process, for any
/// split.
///
/// With FrameSettings::keep_cost, rank 0 also gets the cost of the whole image; with FrameSettings::keep_uncertainty,
/// each pixel's error bound (volume::Renderer::render). Both settings must be the same on all ranks.
class SortFirst final : public VolumeFrames {
 public:
  /// Throws Error(bad_input) unless the settings have no weights, or one positive weight per rank.
  SortFirst(exchange::Transport& transport, const Settings& settings, const FrameSettings& frame = {});
  ~SortFirst() override;

 private:
  VolumePart make(volume::Renderer& renderer, const scene::TransferFunction& function, const VolumeJob& job,
                  std::size_t number, scene::FrameWatch& watch) override;

  class State;
  std::unique_ptr<State> state_;
};

}  // namespace tessera::frame
