// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/deep/window_samples.hpp"
#include "compositor/tile_pixels.hpp"
#include "compositor/tile_scene.hpp"
#include "compositor/tile_sink.hpp"

namespace tessera::compositor {

/// Does the same as DeepSink, but on the lattice, in SIMD lanes, and only for absorption without surfaces. The image is
/// that of PictureSink.
class LatticeDeepSink final : public TileSink<LatticeEncoding> {
 public:
  /// The objects to which `scene` points, the window's image and `target` must outlive this object. Threads share
  /// `target`.
  LatticeDeepSink(const TileScene& scene, const ImageWindow& window, double accuracy, DeepTarget& target);

  void start(const scene::PixelRect& rect) override;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  bool take_unordered(Store&, Depth, scene::StageTimer&) override { return false; }
  [[nodiscard]] const LatticeEncoding::Open& open() const override { return pixels_.open(); }
  [[nodiscard]] bool any_open() const override { return pixels_.any_open(); }
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  scene::Lattice lattice_;
  ImageWindow window_;
  WindowSamples samples_;
  TilePixels<LatticeEncoding> pixels_;
  DeepTarget* target_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< segments taken: in finished rectangles; in this rectangle
};

}  // namespace tessera::compositor
