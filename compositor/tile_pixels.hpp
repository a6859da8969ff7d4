#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compositor/tile_sink.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "projection/footprint.hpp"
#include "projection/pixel_space.hpp"
#include "projection/ray_segments.hpp"
#include "scene/image.hpp"
#include "sorting/pixel_lists.hpp"

namespace tessera::compositor {

/// Where finished pixels go: pixel (x0, y0) of the picture is the image's first.
struct ImageWindow {
  scene::Image* image;
  int x0 = 0, y0 = 0;
};

/// The pixels of a tile while segments are composited into them, front to back.
///
/// Carries premultiplied linear RGB, transmittance and optical depth in double. The opacity is -expm1(-optical depth),
/// so that a hundred thousand segments of opacity 1e-9 add up, and 1 - 1e-8 is not 1.
///
/// A pixel behind which everything left cannot change it by the integrator's termination error is closed; it takes
/// nothing more.
class TilePixels : public TileSink {
 public:
  /// `longest_ray` bounds the world length of a ray inside the data: with independent emission, what may still come
  /// behind a pixel. The window's image must outlive this object; tiles of it are disjoint, so threads may share it.
  TilePixels(const projection::PixelSpace& space, const integrals::SegmentIntegrator& integrator, double max_color,
             double longest_ray, scene::Emission emission, ImageWindow window);

  void start(const scene::PixelRect& rect) override;
  void take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) override;
  bool take_unordered(const projection::RaySegments&, const sorting::PixelLists&, double) override { return false; }
  [[nodiscard]] bool open(std::size_t pixel) const override { return open_[pixel] != 0; }
  [[nodiscard]] std::size_t open_count() const override { return open_count_; }
  /// Writes the pixels into their place in the window's image.
  void finish() override;

 private:
  const projection::PixelSpace* space_;
  const integrals::SegmentIntegrator* integrator_;
  ImageWindow window_;
  double left_out_per_transmittance_, termination_error_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::vector<double> red_, green_, blue_, transmittance_, optical_depth_, first_depth_, length_per_depth_;
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  integrals::SegmentBatch batch_;
};

}  // namespace tessera::compositor
