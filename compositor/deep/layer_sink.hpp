// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/deep/peel_sink.hpp"
#include "compositor/tile_scene.hpp"
#include "compositor/tile_sink.hpp"
#include "compositor/window_kernel.hpp"
#include "integrals/ray_layers.hpp"
#include "integrals/segment_batch.hpp"

namespace tessera::compositor {

/// Does the same as PeelSink, but on the lattice, and only for absorption without surfaces. Segments are composited in
/// SIMD lanes, except segments in which a layer ends, and segments with a large alpha (WindowLayers::most_alpha).
///
/// An error in a layer's optical depth moves the depth at which the layer ends. Light near this end is then in the
/// wrong layer: in the next layer, the first one does not attenuate it. At its end, a layer has the optical depth
/// d = -log(1 - threshold).
///   - Lanes have a relative error of e in a segment's alpha a. This changes the optical depth by e a / (1 - a), which
///     is at most 1.5 e times the segment's optical depth for a <= 1/2, so 1.5 e d in all.
///   - Rounding scalars to the lattice changes the extinction in piece i of the transfer function by at most
///     E (1 / L + sigma_i) / 2 (frame/mesh/lattice_frame.cpp). The lengths y_i of a ray's paths in the pieces satisfy
///     sum y_i <= L and sum sigma_i y_i <= d, so the optical depth changes by at most E (1 + d) / 2.
/// scene::error_budget::scalars_of_layers() computes the sum of both errors.
class LayerSink final : public TileSink<LatticeEncoding>, private WindowLayers {
 public:
  /// `function` is the transfer function on the lattice (FrameLattice::function). The objects to which `scene` points,
  /// the window's image and `target` must outlive this object. Threads share `target`.
  LayerSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
            const Peel& peel, DeepTarget& target);

  void start(const scene::PixelRect& rect) override;
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  bool take_unordered(Store&, Depth, scene::StageTimer&) override { return false; }
  [[nodiscard]] const LatticeEncoding::Open& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return open_count_ > 0; }
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  void add(std::span<const End> ends) override;
  [[nodiscard]] integrals::OpenLayer layer_of(std::size_t pixel) const;
  void resume(std::size_t pixel, const integrals::OpenLayer& layer);
  void note_ended(std::uint32_t pixel);

  TileScene scene_;
  ImageWindow window_;
  integrals::RayLayers layers_;
  double end_transmittance_;
  WindowRules rules_;
  DeepTarget* target_;
  scene::PixelRect rect_{0, 0, 0, 0};
  projection::OpenPixels open_{};
  int open_count_ = 0;
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< segments taken: in finished rectangles; in this rectangle
  WindowState state_;
  /// The layer of each pixel after the last segment that was added in double precision. `state_` also contains what the
  /// lanes have added since.
  std::vector<integrals::OpenLayer> cut_;
  std::vector<double> length_per_depth_;
  integrals::SegmentBatch batch_;
  std::vector<integrals::RayLayer> ended_;
  std::vector<PixelLayer> made_;  ///< layers of all pixels; those of one pixel are in order
};

}  // namespace tessera::compositor
