// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/frame_watch.hpp"
#include "scene/image.hpp"
#include "volume/fragment_sink.hpp"

namespace tessera::volume {

/// Writes fragments, each the whole light of its pixel, into an image: colours of 0 or more, opacity in [0, 1], and the
/// depth where light begins. Pixels that no fragment comes for stay as they are.
class ImageSink final : public FragmentSink {
 public:
  /// `error_bounds`, unless null, gets those of the fragments, by the pixel's index in the image. `watch` hears of
  /// finished pixels. All must outlive the sink.
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
