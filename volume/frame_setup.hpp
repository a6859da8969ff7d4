// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "volume/frame_view.hpp"
#include "volume/lane_error_bound.hpp"
#include "volume/lanes/preintegrated_table.hpp"
#include "volume/renderer_state.hpp"

namespace tessera::volume {

/// The data that the tiles of one frame of a regular grid share. They are computed once per frame; view() refers to
/// them.
class FrameSetup {
 public:
  /// Camera and size must be valid. `tally` is set for a pilot pass, and null for an image. `state` and `tally` must
  /// outlive this object. Uses the calling thread's arena.
  FrameSetup(RendererState& state, const scene::Camera& camera, scene::ImageSize size,
             const scene::TransferFunction& function, WorkTally* tally);
  FrameSetup(const FrameSetup&) = delete;
  FrameSetup& operator=(const FrameSetup&) = delete;

  [[nodiscard]] const FrameView& view() const { return view_; }
  /// One byte per cell of 8^3 voxels, and one per brick: whether any part of it is visible.
  [[nodiscard]] const std::vector<std::uint8_t>& visible() const { return visible_; }
  [[nodiscard]] const std::vector<std::uint8_t>& brick_visible() const { return brick_visible_; }
  /// Time that computing the visibility took, in microseconds.
  [[nodiscard]] std::uint64_t cull_us() const { return cull_us_; }
  [[nodiscard]] const GridSurfaces* surfaces() const { return &surfaces_; }

 private:
  void find_visible(RendererState& state);
  [[nodiscard]] std::vector<std::uint8_t> visible_to_table(const RendererState& state) const;
  void set_up_surfaces(const RendererState& state, const scene::TransferFunction& function);
  void set_up_method(const RendererState& state, const scene::TransferFunction& function);

  PixelRays rays_;
  integrals::LaneTable table_;
  std::vector<std::uint8_t> visible_, brick_visible_;
  std::uint64_t cull_us_ = 0;
  LaneErrorBound error_bound_;
  std::optional<PreintegratedTable> preintegrated_;
  std::optional<ShadingView> shading_;
  GridSurfaces surfaces_;
  std::optional<SurfaceView> surface_view_;
  FrameView view_{};
};

}  // namespace tessera::volume
