// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tessera/deep_image.hpp"
#include "tessera/image.hpp"
#include "tessera/pixel_rect.hpp"
#include "tessera/settings.hpp"
#include "tessera/statistics.hpp"

namespace tessera {
inline namespace v0_1 {

/// A finished picture, or one that was stopped.
struct RenderedFrame {
  std::size_t number = 0;      ///< in the list that was asked for
  bool stopped = false;        ///< the image lacks pixels; nothing else is set
  Image image;                 ///< on the rank that assembles it; elsewhere empty
  DeepImage deep;              ///< if FrameSettings::deep
  FrameStatistics statistics;  ///< on the rank that assembles
  /// If FrameSettings::keep_uncertainty, of grids: by pixel, what single precision may err there in linear RGBA.
  std::vector<float> uncertainty;
  /// If FrameSettings::peel: Peel::layers images, each ray's light between two cuts, as if nothing lay in front of it,
  /// from the eye on; composited front to back they are the image. `depth` is where a layer's light begins, infinite
  /// where a layer has none, as behind a ray's end. Each is right to 1e-5. A surface, which has no inside to cut, is
  /// the end of the layer that reaches the threshold with it. With FrameSettings::deep the deep picture's samples are
  /// the layers: their density is not constant, so that they err where they are cut.
  std::vector<Image> layers{};
  std::optional<Peel> peel{};  ///< how the layers were cut; none: there are none
};

/// Pixels of a frame that have their final values.
struct Tile {
  std::size_t frame;   ///< in the list that was asked for; of several frames in flight perhaps not the first
  PixelRect rect;      ///< every pixel of a frame is in one tile
  const Image& image;  ///< of the whole picture; outside of finished tiles its pixels mean nothing yet
};

/// Who is told of pixels while they are made, on the rank that assembles: one call at a time, from any thread. What a
/// call throws stops the frame on all ranks and comes out of Session::render there.
class Sink {
 public:
  virtual ~Sink() = default;
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  /// Whether tile() is to be called at all.
  [[nodiscard]] virtual bool wants_tiles() const { return true; }
  virtual void tile(const Tile& /*tile*/) {}
  /// Of a list of frames: each as it is complete, in order; the last one may be stopped, which every rank is told.
  virtual void frame(RenderedFrame&& /*frame*/) {}
  /// Before the first pixel of a mesh's frame on several ranks: an image that the sink no longer needs, for the frame
  /// to be made in its memory, whatever is in it, as fresh memory is slow to fill. One of another size is not used; by
  /// default there is none.
  virtual Image spare_image(ImageSize /*size*/) { return {}; }
};

}  // namespace v0_1
}  // namespace tessera
