#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "compositor/segment_batch.hpp"
#include "compositor/segment_integrator.hpp"
#include "projection/footprint.hpp"
#include "projection/pixel_space.hpp"
#include "projection/ray_segments.hpp"
#include "scene/image.hpp"
#include "sorting/pixel_lists.hpp"

namespace tessera::compositor {

/// The pixels of a tile while segments are composited into them, front to back.
///
/// Carries premultiplied linear RGB, transmittance and optical depth in double. The opacity is -expm1(-optical depth),
/// so that a hundred thousand segments of opacity 1e-9 add up, and 1 - 1e-8 is not 1.
class TilePixels {
 public:
  /// `longest_ray` bounds the world length of a ray inside the data: with independent emission, what may still come
  /// behind a pixel.
  TilePixels(const projection::PixelSpace& space, const SegmentIntegrator& integrator, double max_color,
             double longest_ray, scene::Emission emission);

  /// Forgets all and starts on the pixels of `rect`.
  void start(const projection::PixelRect& rect);

  /// Composites, in each pixel's order, the segments whose front lies before `final_depth`: no later segment may come
  /// before them. A pixel behind which everything left cannot change it by the integrator's termination error is
  /// closed; it takes nothing more.
  void composite(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth);

  [[nodiscard]] bool open(std::size_t pixel) const { return open_[pixel] != 0; }
  [[nodiscard]] std::size_t open_count() const { return open_count_; }

  /// Writes the finished pixels into their place.
  void store(scene::Image& image) const;

 private:
  const projection::PixelSpace* space_;
  const SegmentIntegrator* integrator_;
  double left_out_per_transmittance_, termination_error_;
  projection::PixelRect rect_{0, 0, 0, 0};
  std::vector<double> red_, green_, blue_, transmittance_, optical_depth_, first_depth_, length_per_depth_;
  std::vector<std::uint8_t> open_;
  std::size_t open_count_ = 0;
  SegmentBatch batch_;
};

}  // namespace tessera::compositor
