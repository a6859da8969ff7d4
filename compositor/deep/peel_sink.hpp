// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/tile_scene.hpp"
#include "compositor/tile_sink.hpp"
#include "integrals/ray_layers.hpp"
#include "integrals/segment_batch.hpp"

namespace tessera::compositor {

/// A layer, and the number of its pixel in the rectangle.
struct PixelLayer {
  std::uint32_t pixel;
  integrals::RayLayer layer;
};

/// Computes the layers of an image (integrals/ray_layers.hpp), and the image from the layers. Layers are stored as deep
/// samples: the first sample of a pixel is its first layer, and so on to the end of the ray.
///
/// A pixel whose image is opaque still accepts segments until its last layer is opaque as well.
class PeelSink final : public TileSink<DoubleEncoding> {
 public:
  /// The objects to which `scene` points, the window's image and `target` must outlive this object. Threads share
  /// `target`.
  PeelSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
           scene::Emission emission, const Peel& peel, DeepTarget& target);

  void start(const scene::PixelRect& rect) override;
  void take(Store& lists, double final_depth, std::size_t at_least, scene::StageTimer& timer) override;
  bool take_unordered(Store&, double, scene::StageTimer&) override { return false; }
  [[nodiscard]] const std::vector<std::uint8_t>& open() const override { return open_; }
  [[nodiscard]] bool any_open() const override { return open_count_ > 0; }
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  /// A segment, or a crossing of a surface, that waits to be integrated.
  struct Waiting {
    std::uint32_t pixel, tet;
    double front, back, scalar_front, scalar_back;
  };
  void integrate_waiting(scene::StageTimer& timer);
  void add(std::size_t k);
  [[nodiscard]] bool is_crossing(const Waiting& w) const;

  TileScene scene_;
  ImageWindow window_;
  integrals::RayLayers layers_;
  DeepTarget* target_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< segments taken: in finished rectangles; in this rectangle
  std::vector<integrals::OpenLayer> rays_;          ///< one per pixel
  std::vector<double> length_per_depth_;
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  std::vector<Waiting> waiting_;  ///< segments of all pixels; those of one pixel are in order
  integrals::SegmentBatch batch_;
  std::vector<integrals::RayLayer> ended_;
  std::vector<PixelLayer> made_;  ///< layers of all pixels; those of one pixel are in order
};

/// Composites layers to the pixels of `rect` in the window's image, and passes them to `target`. Sorts `layers` by
/// pixel; those of one pixel must be in order.
void deliver_layers(const scene::PixelRect& rect, std::vector<PixelLayer>& layers, const ImageWindow& window,
                    DeepTarget& target);

/// Appends the layers of one pixel as deep samples with rounded depths. In contrast to other deep images, two samples
/// may be points at the same depth.
void append_layers(std::span<const integrals::RayLayer> layers, std::vector<scene::DeepImageSample>& to);

}  // namespace tessera::compositor
