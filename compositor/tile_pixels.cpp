#include "compositor/tile_pixels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tessera::compositor {

TilePixels::TilePixels(const projection::PixelSpace& space, const integrals::SegmentIntegrator& integrator,
                       double max_color, double longest_ray, scene::Emission emission, ImageWindow window)
    : space_(&space), integrator_(&integrator), window_(window), termination_error_(integrator.termination_error()) {
  left_out_per_transmittance_ = integrals::opacity_weight(max_color, longest_ray, emission);
}

void TilePixels::start(const scene::PixelRect& rect) {
  rect_ = rect;
  const auto n = static_cast<std::size_t>(rect.area());
  for (auto* channel : {&red_, &green_, &blue_, &optical_depth_}) channel->assign(n, 0.0);
  transmittance_.assign(n, 1.0);
  first_depth_.assign(n, std::numeric_limits<double>::infinity());
  open_.assign(n, 1);
  open_count_ = n;
  length_per_depth_.resize(n);
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) length_per_depth_[i++] = space_->length_per_depth(x + 0.5, y + 0.5);
}

void TilePixels::take(const projection::RaySegments& segments, const sorting::PixelLists& lists, double final_depth) {
  const auto is_final = [&](const sorting::PixelLists::Entry& entry) { return entry.depth < final_depth; };
  batch_.reserve(segments.size);
  batch_.size = 0;
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    for (const auto& entry : lists.pixel(p)) {
      if (!is_final(entry)) break;
      const std::uint32_t i = entry.segment;
      batch_.length[batch_.size] = (segments.back[i] - segments.front[i]) * length_per_depth_[p];
      batch_.scalar_front[batch_.size] = segments.scalar_front[i];
      batch_.scalar_back[batch_.size] = segments.scalar_back[i];
      ++batch_.size;
    }
  }
  integrator_->integrate(batch_);

  std::size_t next = 0;
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    double red = red_[p], green = green_[p], blue = blue_[p], transmittance = transmittance_[p],
           depth = optical_depth_[p];
    bool open = true;
    for (const auto& entry : lists.pixel(p)) {
      if (!is_final(entry)) break;
      const std::size_t k = next++;
      if (!open) continue;
      if (depth == 0 && batch_.optical_depth[k] > 0 && std::isinf(first_depth_[p])) {
        const std::uint32_t i = entry.segment;
        const double at = integrator_->first_visible(segments.scalar_front[i], segments.scalar_back[i]).value_or(0);
        first_depth_[p] = segments.front[i] + (segments.back[i] - segments.front[i]) * at;
      }
      red += transmittance * batch_.red[k];
      green += transmittance * batch_.green[k];
      blue += transmittance * batch_.blue[k];
      depth += batch_.optical_depth[k];
      transmittance *= batch_.transmittance[k];
      // After each segment, not each batch: where a ray ends must not depend on how segments were batched.
      open = transmittance * left_out_per_transmittance_ >= termination_error_;
    }
    red_[p] = red, green_[p] = green, blue_[p] = blue, transmittance_[p] = transmittance, optical_depth_[p] = depth;
    if (!open) {
      open_[p] = 0;
      --open_count_;
    }
  }
}

void TilePixels::finish() {
  scene::Image& image = *window_.image;
  std::size_t i = 0;
  for (int y = rect_.y0; y < rect_.y1; ++y)
    for (int x = rect_.x0; x < rect_.x1; ++x, ++i) {
      const std::size_t at = image.index(x - window_.x0, y - window_.y0);
      image.rgba[4 * at + 0] = static_cast<float>(red_[i]);
      image.rgba[4 * at + 1] = static_cast<float>(green_[i]);
      image.rgba[4 * at + 2] = static_cast<float>(blue_[i]);
      image.rgba[4 * at + 3] = static_cast<float>(-std::expm1(-optical_depth_[i]));
      image.depth[at] = static_cast<float>(first_depth_[i]);
    }
}

}  // namespace tessera::compositor
