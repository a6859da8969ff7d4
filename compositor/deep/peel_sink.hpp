// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/tile_pixels.hpp"
#include "compositor/tile_sink.hpp"
#include "integrals/ray_layers.hpp"
#include "integrals/segment_batch.hpp"

namespace tessera::compositor {

/// A picture and, beside it, its layers (integrals/ray_layers.hpp), each a deep sample: of a pixel the first sample is
/// of the first layer, and so on to where the ray ends. The samples are as append_layers() has them.
///
/// A pixel stays open behind opaque matter until its last layer is opaque too.
class PeelSink final : public TileSink<DoubleEncoding> {
 public:
  /// The scene's values, the window's image and `target` must outlive this object; threads share the target.
  PeelSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
           scene::Emission emission, const Peel& peel, DeepTarget& target);

  void start(const scene::PixelRect& rect) override;
  void take(Store& lists, double final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  bool take_unordered(Store&, double, scene::StageTimer&) override { return false; }
  [[nodiscard]] const std::vector<std::uint8_t>& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return picture_.any_open() || layers_open_count_ > 0; }
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  /// A segment that waits for the integrator, or a crossing.
  struct Waiting {
    std::uint32_t pixel, tet;
    double front, back, scalar_front, scalar_back;
  };
  struct PixelLayer {
    std::uint32_t pixel;
    integrals::RayLayer layer;
  };

  void integrate_waiting(scene::StageTimer& timer);
  void add(std::size_t k);
  [[nodiscard]] bool is_crossing(const Waiting& w) const;

  TileScene scene_;
  TilePixels<DoubleEncoding> picture_;
  ImageWindow window_;
  integrals::RayLayers layers_;
  DeepTarget* target_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< of finished rectangles, of this one
  std::vector<integrals::OpenLayer> rays_;          ///< one a pixel
  std::vector<double> length_per_depth_;
  std::vector<std::uint8_t> open_, layers_open_;
  std::size_t layers_open_count_ = 0;
  std::vector<Waiting> waiting_;  ///< each pixel's in order
  integrals::SegmentBatch batch_;
  std::vector<integrals::RayLayer> ended_;
  std::vector<PixelLayer> made_;  ///< in each pixel's order
};

/// Layers of one pixel as deep samples, depths rounded. Two may be points at one depth, which deep pictures do not
/// have.
void append_layers(std::span<const integrals::RayLayer> layers, std::vector<scene::DeepImageSample>& to);

}  // namespace tessera::compositor
