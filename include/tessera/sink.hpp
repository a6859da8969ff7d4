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

/// A frame that was completed or stopped.
struct RenderedFrame {
  std::size_t number = 0;      ///< number of the frame in the list of views
  bool stopped = false;        ///< rendering was stopped: the image is incomplete, and no other member but `number` is
                               ///< set
  Image image;                 ///< on the rank that assembles; empty on other ranks
  DeepImage deep;              ///< if FrameSettings::deep
  FrameStatistics statistics;  ///< on the rank that assembles
  /// With FrameSettings::keep_uncertainty, for grids: for each pixel the possible error due to single precision, in
  /// linear RGBA.
  std::vector<float> uncertainty;
  /// With FrameSettings::peel: Peel::layers images. Each layer contains the light between two cuts of the rays, without
  /// attenuation by anything in front. The first layer starts at the eye. Composited front to back, the layers equal
  /// the image. `depth` is the depth where the layer's light begins; it is infinite where the layer is empty, as beyond
  /// the end of a ray. Each layer is correct to 1e-5. Surfaces cannot be cut: if a layer reaches the threshold at a
  /// surface, the layer ends with this surface. With FrameSettings::deep, the samples of the deep image are the layers.
  /// Their density is not constant, so that cutting them is not exact.
  std::vector<Image> layers{};
  std::optional<Peel> peel{};  ///< how the layers were cut; none if there are no layers
};

/// Pixels of a frame that have their final values.
struct Tile {
  std::size_t frame;   ///< number of the frame in the list of views; tiles of several frames may alternate
  PixelRect rect;      ///< the pixels of the tile; every pixel of a frame is in exactly one tile
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
  /// Called with each complete frame of a list of frames, in order. If rendering is stopped, the last call passes the
  /// stopped frame, on every rank.
  virtual void frame(RenderedFrame&& /*frame*/) {}
  /// Returns an image that the sink no longer needs. Called before the first pixel of a frame of a mesh on several
  /// ranks, which reuses the memory of the image, since new memory is slow to fill. The contents of the image do not
  /// matter. An image of another size is ignored. The default implementation returns an empty image.
  virtual Image spare_image(ImageSize /*size*/) { return {}; }
};

}  // namespace v0_1
}  // namespace tessera
