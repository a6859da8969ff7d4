#include "compositor/window_pixels.hpp"

#include <limits>

namespace tessera::compositor {

void WindowPixels::start(const scene::PixelRect& rect) {
  rect_ = rect;
  segments_here_ = 0;
  state_.start(rect, *scene_.space);
  open_count_ = state_.open_pixels(rect, open_);
}

void WindowPixels::take(projection::SegmentWindows& windows, std::int64_t final_step, std::size_t at_least,
                        scene::TraceLaps& laps) {
  segments_here_ += composite_windows(rules_, windows, final_step, at_least, state_, laps);
  open_count_ = state_.open_pixels(rect_, open_);
  laps.lap("composite");
}

void WindowPixels::finish() {
  segments_ += segments_here_;
  scene::Image& image = *window_.image;
  const WindowState& s = state_;
  std::size_t p = 0;
  for (int y = rect_.y0; y < rect_.y1; ++y)
    for (int x = rect_.x0; x < rect_.x1; ++x, ++p) {
      const std::size_t at = image.index(x - window_.x0, y - window_.y0);
      image.rgba[4 * at + 0] = static_cast<float>(s.red[p]);
      image.rgba[4 * at + 1] = static_cast<float>(s.green[p]);
      image.rgba[4 * at + 2] = static_cast<float>(s.blue[p]);
      image.rgba[4 * at + 3] = static_cast<float>(1 - s.transmittance[p]);
      image.depth[at] = std::numeric_limits<float>::infinity();
      if (s.first_back[p] != WindowState::not_yet)
        image.depth[at] = static_cast<float>(first_visible_depth(
            scene_.lattice, {s.first_front[p], s.first_back[p], s.first_scalar_front[p], s.first_scalar_back[p]},
            *scene_.integrator));
    }
}

}  // namespace tessera::compositor
