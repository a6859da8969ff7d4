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

/// A finished frame, or one that was stopped.
struct RenderedFrame {
  std::size_t number = 0;      ///< in the list of views
  bool stopped = false;        ///< the image lacks pixels; nothing else is set
  Image image;                 ///< on the rank that assembles; empty on others
  DeepImage deep;              ///< if FrameSettings::deep
  FrameStatistics statistics;  ///< on the rank that assembles
  /// With FrameSettings::keep_uncertainty, for grids: possible error of single precision by pixel, in linear RGBA.
  std::vector<float> uncertainty;
  /// With FrameSettings::peel: Peel::layers images. Each contains a ray's light between two cuts, without attenuation
  /// by anything in front, starting at the eye; composited front to back they equal the image. `depth` is where a
  /// layer's light begins, infinite where a layer has none, as beyond a ray's end. Each layer is correct to 1e-5. A
  /// surface has no inside to cut: it ends the layer that reaches the threshold with it. With FrameSettings::deep the
  /// samples of the deep image are the layers: their density is not constant, so cutting them is not exact.
  std::vector<Image> layers{};
  std::optional<Peel> peel{};  ///< how the layers were cut; none: there are no layers
};

/// Pixels of a frame that have their final values.
struct Tile {
  std::size_t frame;   ///< in the list of views; with several frames in flight not always the first
  PixelRect rect;      ///< every pixel of a frame is in one tile
  const Image& image;  ///< the whole image; pixels outside finished tiles are undefined
};

/// Receives pixels as they are produced, on the rank that assembles: one call at a time, from any thread. An exception
/// from a call stops the frame on all ranks and propagates from Session::render on this rank.
class Sink {
 public:
  virtual ~Sink() = default;
  Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;

  /// Whether tile() should be called at all.
  [[nodiscard]] virtual bool wants_tiles() const { return true; }
  virtual void tile(const Tile& /*tile*/) {}
  /// For a list of frames: called with each complete frame, in order; the last one may be stopped, on every rank.
  virtual void frame(RenderedFrame&& /*frame*/) {}
  /// Called before the first pixel of a mesh's frame on several ranks: returns an image that the sink no longer needs,
  /// whose memory the frame reuses whatever it contains, as fresh memory is slow to fill. An image of another size is
  /// ignored; the default returns none.
  virtual Image spare_image(ImageSize /*size*/) { return {}; }
};

}  // namespace v0_1
}  // namespace tessera
