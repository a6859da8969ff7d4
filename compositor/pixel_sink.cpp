// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/pixel_sink.hpp"

#include "exchange/packed_pixels.hpp"

namespace tessera::compositor {

template <class Encoding>
void PixelSink<Encoding>::begin_tile(std::size_t tile, const scene::PixelRect& rect) {
  FragmentSink<Encoding>::begin_tile(tile, rect);
  tile_ = tile;
  tile_rect_ = rect;
  if (image_.size.width != rect.width() || image_.size.height != rect.height())
    image_ = scene::Image({rect.width(), rect.height()});
}

template <class Encoding>
void PixelSink<Encoding>::start(const scene::PixelRect& rect) {
  rect_ = rect;
  segments_here_ = 0;
  pixels_.start(rect);
}

template <class Encoding>
void PixelSink<Encoding>::finish() {
  segments_ += segments_here_;
  write_pixels(pixels_, rect_, {&image_, tile_rect_.x0, tile_rect_.y0});
}

template <class Encoding>
void PixelSink<Encoding>::end_tile() {
  exchange::append_pixels(writer_.records(), image_, {0, 0, tile_rect_.width(), tile_rect_.height()}, packs_(tile_));
  writer_.end_tile();
}

template class PixelSink<DoubleEncoding>;
template class PixelSink<LatticeEncoding>;

}  // namespace tessera::compositor
