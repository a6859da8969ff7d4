#pragma once

#include <span>
#include <vector>

#include "compositor/deep_collector.hpp"
#include "compositor/deep_fragments.hpp"
#include "compositor/deep_pieces.hpp"
#include "compositor/tile_sink.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/pixel_space.hpp"

namespace tessera::compositor {

/// Makes a tile's ray segments into deep samples: cuts them into pieces, integrates these, merges them. The integrator
/// must be `exact`, so that the light of a segment is that of its pieces. Pixels close as in TilePixels.
class DeepSink final : public TileSink {
 public:
  /// `integrator`, `space` and `collector` must outlive this object; threads share the collector.
  DeepSink(const projection::PixelSpace& space, const integrals::SegmentIntegrator& integrator,
           const scene::TransferFunction& function, double longest_ray, scene::Emission emission, double accuracy,
           DeepTarget& collector);

  void start(const scene::PixelRect& rect) override;
  void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) override;
  bool take_unordered(const projection::RaySegments&, const sorting::PixelLists&, double) override { return false; }
  [[nodiscard]] bool open(std::size_t pixel) const override { return open_[pixel] != 0; }
  [[nodiscard]] std::size_t open_count() const override { return open_count_; }
  void finish() override;

  /// Working memory a pixel of the tile.
  static constexpr std::size_t bytes_a_pixel = sizeof(DeepMerger) + 3 * sizeof(double);

 private:
  void integrate_pieces();

  const projection::PixelSpace* space_;
  const integrals::SegmentIntegrator* integrator_;
  PieceCutter cutter_;
  double accuracy_, left_out_per_transmittance_, termination_error_;
  DeepTarget* collector_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::vector<DeepMerger> mergers_;  ///< one a pixel
  std::vector<double> transmittance_before_, length_per_depth_;
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  std::vector<DeepPiece> pieces_;  ///< that wait for the integrator
  std::vector<std::uint32_t> piece_pixels_;
  integrals::SegmentBatch batch_;
  struct PixelSample {
    std::uint32_t pixel;
    DeepSample sample;
  };
  std::vector<DeepSample> ended_;
  std::vector<PixelSample> samples_;  ///< in each pixel's order
};

/// The samples of one pixel, in order, as floats, tidy: depths are rounded, which keeps their order; samples that
/// rounding makes points at one depth become one; samples without alpha and light are left out.
void append_tidy(std::span<const DeepSample> samples, std::vector<scene::DeepImageSample>& to);

}  // namespace tessera::compositor
