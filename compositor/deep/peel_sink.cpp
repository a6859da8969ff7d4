// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/peel_sink.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "compositor/finite_float.hpp"

namespace tessera::compositor {
namespace {

/// Number of segments that are integrated together: they fit into a core's second-level cache.
constexpr std::size_t batch_segments = 8192;

}  // namespace

void append_layers(std::span<const integrals::RayLayer> layers, std::vector<scene::DeepImageSample>& to) {
  for (const integrals::RayLayer& l : layers)
    to.push_back({finite_float(l.front), finite_float(l.back), finite_float(std::max(0.0, l.red)),
                  finite_float(std::max(0.0, l.green)), finite_float(std::max(0.0, l.blue)),
                  static_cast<float>(-std::expm1(-l.optical_depth))});
}

void deliver_layers(const scene::PixelRect& rect, std::vector<PixelLayer>& layers, const ImageWindow& window,
                    DeepTarget& target) {
  std::stable_sort(layers.begin(), layers.end(),
                   [](const PixelLayer& a, const PixelLayer& b) { return a.pixel < b.pixel; });
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(rect.area()), 0);
  std::vector<scene::DeepImageSample> samples;
  auto next = layers.cbegin();
  std::uint32_t p = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x, ++p) {
      double red = 0, green = 0, blue = 0, optical_depth = 0;
      double depth = std::numeric_limits<double>::infinity();
      for (; next != layers.cend() && next->pixel == p; ++next, ++counts[p]) {
        const integrals::RayLayer& layer = next->layer;
        const double through = std::exp(-optical_depth);
        red += through * layer.red, green += through * layer.green, blue += through * layer.blue;
        if (optical_depth == 0 && layer.optical_depth > 0) depth = layer.front;
        optical_depth += layer.optical_depth;
        append_layers(std::span(&layer, 1), samples);
      }
      window.put(x, y, {red, green, blue, -std::expm1(-optical_depth), depth});
    }
  target.add(rect, std::move(counts), std::move(samples));
}

PeelSink::PeelSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
                   scene::Emission emission, const Peel& peel, DeepTarget& target)
    : scene_(scene),
      window_(window),
      layers_(function, emission, peel, scene.integrator->termination_error() > 0),
      target_(&target) {}

void PeelSink::start(const scene::PixelRect& rect) {
  rect_ = rect;
  segments_here_ = 0;
  const auto n = static_cast<std::size_t>(rect.area());
  rays_.assign(n, {});
  open_.assign(n, 1);
  open_count_ = n;
  length_per_depth_.resize(n);
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) length_per_depth_[i++] = scene_.space->length_per_depth(x + 0.5, y + 0.5);
  waiting_.clear();
  made_.clear();
}

bool PeelSink::is_crossing(const Waiting& w) const {
  return scene_.surfaces != nullptr && projection::is_crossing(w.scalar_front);
}

void PeelSink::take(Store& lists, double final_depth, std::size_t /*at_least*/, scene::StageTimer& timer) {
  lists.sort();
  timer.record("sort");
  const projection::RaySegments& segments = lists.segments;
  for (std::uint32_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    for (const auto& entry : lists.pixel(p)) {
      if (!(entry.depth < final_depth)) break;
      const std::uint32_t i = entry.segment;
      const std::uint32_t tet = scene_.light != nullptr ? segments.tet(i) : 0;
      waiting_.push_back(
          {p, tet, segments.front[i], segments.back[i], segments.scalar_front[i], segments.scalar_back[i]});
      if (waiting_.size() >= batch_segments) integrate_waiting(timer);
    }
  }
  integrate_waiting(timer);
  segments_here_ += lists.remove(final_depth, open_);
  timer.record("composite");
}

void PeelSink::integrate_waiting(scene::StageTimer& timer) {
  timer.record("composite");
  batch_.reserve(waiting_.size());
  batch_.size = waiting_.size();
  for (std::size_t k = 0; k < waiting_.size(); ++k) {
    const Waiting& w = waiting_[k];
    batch_.length[k] = (w.back - w.front) * length_per_depth_[w.pixel];
    // The front scalar of a crossing is a mark, not a field value.
    batch_.scalar_front[k] = is_crossing(w) ? w.scalar_back : w.scalar_front;
    batch_.scalar_back[k] = w.scalar_back;
  }
  layers_.integrator().integrate(batch_);
  timer.record("integrate");
  for (std::size_t k = 0; k < waiting_.size(); ++k)
    if (open_[waiting_[k].pixel]) add(k);
  waiting_.clear();
}

void PeelSink::add(std::size_t k) {
  const Waiting& w = waiting_[k];
  integrals::OpenLayer& ray = rays_[w.pixel];
  ended_.clear();
  if (is_crossing(w)) {
    const projection::Crossing crossing = projection::crossing_of(w.scalar_front);
    const scene::SurfaceSet::Light light = scene_.surfaces->light(crossing.number, crossing.cosine, w.scalar_back);
    layers_.add_surface(w.front, light, ray, ended_);
  } else {
    integrals::RayLayers::Stretch stretch{w.front, w.back, w.scalar_front, w.scalar_back, batch_.length[k]};
    if (scene_.light != nullptr && batch_.optical_depth[k] > 0) {
      const auto p = static_cast<int>(w.pixel);
      const int x = rect_.x0 + p % rect_.width(), y = rect_.y0 + p / rect_.width();
      const projection::MatterLight::Light light =
          scene_.light->on(scene_.normals->of(w.tet), scene_.space->direction(x + 0.5, y + 0.5));
      stretch.own = light.own, stretch.white = light.white;
    }
    layers_.add(stretch, batch_, k, ray, ended_);
  }
  for (const integrals::RayLayer& layer : ended_) made_.push_back({w.pixel, layer});
  if (layers_.transmittance(ray) * scene_.left_out_per_transmittance < layers_.integrator().termination_error()) {
    open_[w.pixel] = 0;
    --open_count_;
  }
}

void PeelSink::finish() {
  segments_ += segments_here_;
  const auto n = static_cast<std::uint32_t>(rect_.area());
  for (std::uint32_t p = 0; p < n; ++p) {
    ended_.clear();
    layers_.end(rays_[p], ended_);
    for (const integrals::RayLayer& layer : ended_) made_.push_back({p, layer});
  }
  deliver_layers(rect_, made_, window_, *target_);
}

}  // namespace tessera::compositor
