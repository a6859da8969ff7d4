// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/deep/deep_fragments.hpp"
#include "compositor/deep/deep_pieces.hpp"
#include "compositor/tile_pixels.hpp"
#include "compositor/tile_sink.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"

namespace tessera::compositor {

/// Computes deep samples and the image: cuts a tile's ray segments into pieces, integrates the pieces, and merges them.
/// The integrator must be `exact`, so that the pieces of a segment together give the segment's light.
class DeepSink final : public TileSink<DoubleEncoding> {
 public:
  /// The objects to which `scene` points, the window's image and `collector` must outlive this object. Threads share
  /// `collector`.
  DeepSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
           scene::Emission emission, double accuracy, DeepTarget& collector);

  void start(const scene::PixelRect& rect) override;
  void take(Store& lists, double final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  bool take_unordered(Store&, double, scene::StageTimer&) override { return false; }
  [[nodiscard]] const std::vector<std::uint8_t>& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return open_count_ > 0; }
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  /// The part of a pixel's image that has been computed so far.
  struct Ray {
    double red = 0, green = 0, blue = 0, optical_depth = 0, depth = std::numeric_limits<double>::infinity();
  };

  void integrate_pieces(scene::StageTimer& timer);
  void add_crossing(std::uint32_t pixel, double depth, const projection::Crossing& crossing, double value);

  TileScene scene_;
  ImageWindow window_;
  PieceCutter cutter_;
  double accuracy_;
  DeepTarget* collector_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< segments taken: in finished rectangles; in this rectangle
  std::vector<DeepMerger> mergers_;                 ///< one per pixel
  std::vector<double> transmittance_before_, length_per_depth_;
  std::vector<Ray> rays_;  ///< one per pixel
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  std::vector<DeepPiece> pieces_;  ///< pieces that wait to be integrated
  std::vector<std::uint32_t> piece_pixels_;
  std::vector<std::uint32_t> piece_tets_;   ///< the tet of each piece; only if matter is lit
  std::vector<CrossingInBatch> crossings_;  ///< crossings of surfaces in the list of pieces
  integrals::SegmentBatch batch_;
  struct PixelSample {
    std::uint32_t pixel;
    DeepSample sample;
  };
  std::vector<DeepSample> ended_;
  std::vector<PixelSample> samples_;  ///< samples of all pixels; those of one pixel are in order
};

/// Appends the next sample of a pixel, whose samples begin at index `first`. Samples at one point, which rounding to
/// floats may produce, are combined. Samples without alpha and light are left out.
void append_tidy(const scene::DeepImageSample& sample, std::size_t first, std::vector<scene::DeepImageSample>& to);

/// Appends all samples of one pixel, in order, as floats. Rounding depths keeps their order.
void append_tidy(std::span<const DeepSample> samples, std::vector<scene::DeepImageSample>& to);

}  // namespace tessera::compositor
