// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "compositor/tile_pixels.hpp"
#include "compositor/tile_sink.hpp"

namespace tessera::compositor {

/// Computes pixels and writes them to an image. The window's image must outlive the sink. Tiles are disjoint, so
/// threads may share the image.
template <class Encoding>
class PictureSink final : public TileSink<Encoding> {
 public:
  using typename TileSink<Encoding>::Store;
  using typename TileSink<Encoding>::Depth;

  PictureSink(const TileScene& scene, const ImageWindow& window) : pixels_(scene, false), window_(window) {}

  void start(const scene::PixelRect& rect) override {
    rect_ = rect;
    segments_here_ = 0;
    pixels_.start(rect);
  }
  void take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) override {
    segments_here_ += pixels_.take(store, final_depth, at_least, timer);
  }
  bool take_unordered(Store&, Depth, scene::StageTimer&) override { return false; }
  [[nodiscard]] const typename Encoding::Open& open() const override { return pixels_.open(); }
  [[nodiscard]] bool any_open() const override { return pixels_.any_open(); }
  /// Writes the rectangle's pixels to the window's image.
  void finish() override;
  [[nodiscard]] std::uint64_t segments() const override { return segments_; }

 private:
  TilePixels<Encoding> pixels_;
  ImageWindow window_;
  scene::PixelRect rect_{0, 0, 0, 0};
  std::uint64_t segments_ = 0, segments_here_ = 0;  ///< segments taken: in finished rectangles; in this rectangle
};

/// Writes the values of the pixels of `rect` to the window's image.
template <class Encoding>
void write_pixels(const TilePixels<Encoding>& pixels, const scene::PixelRect& rect, const ImageWindow& window) {
  std::size_t p = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x, ++p) window.put(x, y, pixels.value(p));
}

template <class Encoding>
void PictureSink<Encoding>::finish() {
  segments_ += segments_here_;
  write_pixels(pixels_, rect_, window_);
}

}  // namespace tessera::compositor
