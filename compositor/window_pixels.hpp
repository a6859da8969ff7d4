#pragma once

#include "compositor/tile_pixels.hpp"
#include "compositor/window_kernel.hpp"
#include "compositor/window_sink.hpp"
#include "integrals/segment_integrator.hpp"

namespace tessera::compositor {

/// The frame's side of a window sink. All must outlive it.
struct WindowScene {
  const projection::PixelSpace* space;
  const integrals::LaneTable* table;
  const integrals::SegmentIntegrator* integrator;  ///< where a segment becomes visible, and the termination error
  scene::Lattice lattice;
  double left_out_per_transmittance;  ///< opacity_weight()

  [[nodiscard]] double least_transmittance() const {
    return integrator->termination_error() / left_out_per_transmittance;
  }
};

/// Pixels of a picture from windows of lattice segments: TilePixels' counterpart.
class WindowPixels final : public WindowSink {
 public:
  WindowPixels(const WindowScene& scene, const ImageWindow& window)
      : scene_(scene), rules_{scene.table, scene.least_transmittance()}, window_(window) {}

  void start(const scene::PixelRect& rect) override;
  void take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
            scene::TraceLaps& laps) override;
  bool take_unordered(projection::SegmentWindows&, std::int64_t, scene::TraceLaps&) override { return false; }
  [[nodiscard]] const projection::OpenPixels& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return open_count_ > 0; }
  /// Writes the pixels of the rectangle into their place in the window's image.
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  WindowScene scene_;
  WindowRules rules_;
  ImageWindow window_;
  scene::PixelRect rect_{0, 0, 0, 0};
  projection::OpenPixels open_{};
  int open_count_ = 0;
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< of finished rectangles, of this one
  WindowState state_;
};

}  // namespace tessera::compositor
