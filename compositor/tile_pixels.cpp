// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/tile_pixels.hpp"

#include <cmath>

namespace tessera::compositor {

using Lists = sorting::SegmentLists;
using ListPixels = TilePixels<sorting::DoubleEncoding>;
using WindowPixels = TilePixels<sorting::LatticeEncoding>;

void ListPixels::start(const scene::PixelRect& rect) {
  const auto n = static_cast<std::size_t>(rect.area());
  rect_ = rect;
  ended.clear();
  pixels_.assign(n, Run{});
  for (std::size_t p = 0; p < n; ++p) pixels_[p].pixel = static_cast<std::uint32_t>(p);
  transmittance_.assign(n, 1.0);
  open_.assign(n, 1);
  open_count_ = n;
  closes_ = true;
  length_per_depth_.resize(n);
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) length_per_depth_[i++] = scene_.space->length_per_depth(x + 0.5, y + 0.5);
}

void light_crossings(const scene::SurfaceSet& surfaces, std::span<const CrossingInBatch> crossings,
                     integrals::SegmentBatch& batch) {
  for (const auto& [at, crossing, value] : crossings) {
    const scene::SurfaceSet::Light light = surfaces.light(crossing.number, crossing.cosine, value);
    batch.red[at] = light.red, batch.green[at] = light.green, batch.blue[at] = light.blue;
    batch.optical_depth[at] = -std::log1p(-light.opacity);  // infinite if the surface is opaque
    batch.transmittance[at] = 1 - light.opacity;
  }
}

void ListPixels::integrate(const Lists& lists, double final_depth) {
  const projection::RaySegments& segments = lists.segments;
  batch_.reserve(segments.size);
  batch_.size = 0;
  crossings_.clear();
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    for (const auto& entry : lists.pixel(p)) {
      if (!(entry.depth < final_depth)) break;
      const std::uint32_t i = entry.segment;
      batch_.length[batch_.size] = (segments.back[i] - segments.front[i]) * length_per_depth_[p];
      batch_.scalar_front[batch_.size] = segments.scalar_front[i];
      batch_.scalar_back[batch_.size] = segments.scalar_back[i];
      if (scene_.surfaces != nullptr && projection::is_crossing(segments.scalar_front[i])) {
        crossings_.push_back({batch_.size, projection::crossing_of(segments.scalar_front[i]), segments.scalar_back[i]});
        batch_.scalar_front[batch_.size] = batch_.scalar_back[batch_.size];
      }
      ++batch_.size;
    }
  }
  scene_.integrator->integrate(batch_);
  if (scene_.light != nullptr) light_matter(lists, final_depth);
  if (!crossings_.empty()) light_crossings(*scene_.surfaces, crossings_, batch_);
}

/// Lights the batch of these lists. The light of crossings is set later, so crossings stay unchanged.
void ListPixels::light_matter(const Lists& lists, double final_depth) {
  std::size_t next = 0;
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    const auto entries = lists.pixel(p);
    if (entries.empty()) continue;
    const auto at = static_cast<int>(p);
    const int x = rect_.x0 + at % rect_.width(), y = rect_.y0 + at / rect_.width();
    const glm::dvec3 ray = scene_.space->direction(x + 0.5, y + 0.5);
    for (const auto& entry : entries) {
      if (!(entry.depth < final_depth)) break;
      const std::size_t k = next++;
      if (!(batch_.optical_depth[k] > 0)) continue;
      const glm::vec3 normal = scene_.normals->of(lists.segments.tet(entry.segment));
      light_segment(scene_.light->on(normal, ray), k, batch_.optical_depth[k], batch_);
    }
  }
}

/// Ends the current run of a pixel.
void ListPixels::end(Run& run) {
  if (run.begun && run.visible()) ended.push_back(run);
  const std::uint32_t pixel = run.pixel;
  run = Run{};
  run.pixel = pixel;
}

void ListPixels::end_runs() {
  for (Run& run : pixels_) end(run);
}

template <bool runs>
void ListPixels::add(const Lists& lists, double final_depth) {
  const projection::RaySegments& segments = lists.segments;
  const double termination_error = scene_.integrator->termination_error();
  std::size_t next = 0;
  for (std::size_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    Run run = pixels_[p];
    double transmittance = transmittance_[p];
    bool open = true;
    for (const auto& entry : lists.pixel(p)) {
      if (!(entry.depth < final_depth)) break;
      const std::uint32_t i = entry.segment;
      const std::size_t k = next++;
      if (!open) continue;
      const bool absorbs = batch_.optical_depth[k] > 0;
      bool appears = absorbs && run.optical_depth == 0 && std::isinf(run.front);
      if constexpr (runs) {
        // A run of light without optical depth (independent emission) ends where absorption begins, because the front
        // of an absorbing fragment is the depth at which absorption begins.
        if (run.begun && (run.back != segments.front[i] || (absorbs && run.optical_depth == 0 && run.visible())))
          end(run);
        run.begun = true;
        run.back = segments.back[i];
        appears = !run.visible();
      }
      if (appears) {
        const double at =
            absorbs && segments.front[i] < segments.back[i]
                ? scene_.integrator->first_visible(segments.scalar_front[i], segments.scalar_back[i]).value_or(0)
                : 0;
        run.front = segments.front[i] + (segments.back[i] - segments.front[i]) * at;
      }
      run.red += run.transmittance * batch_.red[k];
      run.green += run.transmittance * batch_.green[k];
      run.blue += run.transmittance * batch_.blue[k];
      run.optical_depth += batch_.optical_depth[k];
      run.transmittance *= batch_.transmittance[k];
      transmittance *= batch_.transmittance[k];
      // This is decided after each segment, not after each batch: where a ray ends must not depend on how segments were
      // batched.
      open = !closes_ || transmittance * scene_.left_out_per_transmittance >= termination_error;
    }
    if (runs && !open) end(run);
    pixels_[p] = run;
    transmittance_[p] = transmittance;
    if (!open) {
      open_[p] = 0;
      --open_count_;
    }
  }
}

void ListPixels::composite(Lists& lists, double final_depth, scene::StageTimer& timer) {
  lists.sort();
  timer.record("sort");
  integrate(lists, final_depth);
  timer.record("integrate");
  runs_ ? add<true>(lists, final_depth) : add<false>(lists, final_depth);
  timer.record("composite");
}

PixelValue ListPixels::value(std::size_t p) const {
  const Run& ray = pixels_[p];
  return {ray.red, ray.green, ray.blue, -std::expm1(-ray.optical_depth), ray.front};
}

void WindowPixels::start(const scene::PixelRect& rect) {
  rect_ = rect;
  rules_.least_transmittance = scene_.least_transmittance();
  state_.start(rect, *scene_.space);
  open_count_ = state_.open_pixels(rect, open_);
}

void WindowPixels::end_runs() {
  for (std::size_t p = 0; p < static_cast<std::size_t>(rect_.area()); ++p) state_.end_run(p);
}

PixelValue WindowPixels::value(std::size_t p) const {
  const WindowState& s = state_;
  double depth = std::numeric_limits<double>::infinity();
  if (s.first_back[p] != WindowState::not_yet)
    depth = first_visible_depth(scene_.lattice,
                                {s.first_front[p], s.first_back[p], s.first_scalar_front[p], s.first_scalar_back[p]},
                                *scene_.integrator);
  return {s.red[p], s.green[p], s.blue[p], 1 - s.transmittance[p], depth};
}

}  // namespace tessera::compositor
