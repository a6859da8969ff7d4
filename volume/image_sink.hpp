// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/frame_watch.hpp"
#include "scene/image.hpp"
#include "volume/fragment_sink.hpp"

namespace tessera::volume {

/// Writes fragments into an image; each fragment must be the whole light of its pixel. Colours are limited to at least
/// 0 and the opacity to [0, 1]; the depth is where light begins. Pixels without a fragment are not changed.
class ImageSink final : public FragmentSink {
 public:
  /// `error_bounds` may be null; otherwise it receives the fragments' error bounds by pixel index. `watch` is notified
  /// of finished pixels. All arguments must outlive the sink.
  ImageSink(scene::Image& image, float* error_bounds, scene::FrameWatch& watch)
      : image_(image), error_bounds_(error_bounds), watch_(watch) {}

  void take(std::span<const RayFragment> fragments) override;
  void finished(const scene::PixelRect& pixels) override { watch_.finished(pixels, image_); }

 private:
  scene::Image& image_;
  float* error_bounds_;
  scene::FrameWatch& watch_;
};

}  // namespace tessera::volume
