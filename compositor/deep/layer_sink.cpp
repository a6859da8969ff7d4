// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/layer_sink.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::compositor {
namespace {

/// The lanes, which use floats, pass a segment to RayLayers slightly before a layer ends; RayLayers then finds the end
/// in double precision.
constexpr double margin = 1 + 2e-6;

}  // namespace

LayerSink::LayerSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
                     const Peel& peel, DeepTarget& target)
    : scene_(scene),
      window_(window),
      layers_(function, scene::Emission::absorption, peel, scene.integrator->termination_error() > 0),
      end_transmittance_((1 - peel.threshold) * margin),
      rules_{.table = scene.table, .least_transmittance = 0, .layers = this},
      target_(&target) {}

void LayerSink::start(const scene::PixelRect& rect) {
  rect_ = rect;
  segments_here_ = 0;
  state_.start(rect, *scene_.space);
  open_count_ = state_.open_pixels(rect, open_);
  const auto n = static_cast<std::size_t>(rect.area());
  cut_.assign(n, {});
  made_.clear();
  length_per_depth_.resize(n);
  end_at.fill(0), least.fill(0);
  last_back.fill(WindowState::not_yet);
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x, ++i) {
      length_per_depth_[i] = scene_.space->length_per_depth(x + 0.5, y + 0.5);
      resume(i, {});
    }
}

void LayerSink::take(Store& store, Depth final_depth, std::size_t at_least, scene::StageTimer& timer) {
  segments_here_ += composite_windows(rules_, store, final_depth, at_least, state_, timer);
  open_count_ = state_.open_pixels(rect_, open_);
  timer.record("composite");
}

/// Returns the current layer of a pixel.
integrals::OpenLayer LayerSink::layer_of(std::size_t p) const {
  const scene::Lattice& lattice = scene_.lattice;
  integrals::OpenLayer layer = cut_[p];
  layer.red = state_.red[p], layer.green = state_.green[p], layer.blue = state_.blue[p];
  // The alpha of a lane may exceed 1 by rounding.
  layer.transmittance = std::max(state_.transmittance[p], 0.0);
  layer.optical_depth = -std::log(layer.transmittance);  // infinite if the layer is opaque
  if (std::isinf(layer.front) && state_.first_back[p] != WindowState::not_yet)
    layer.front = first_visible_depth(
        lattice,
        {state_.first_front[p], state_.first_back[p], state_.first_scalar_front[p], state_.first_scalar_back[p]},
        layers_.integrator());
  if (last_back[p] != WindowState::not_yet) {
    layer.last_front = lattice.depth(last_front[p]), layer.last_back = lattice.depth(last_back[p]);
    layer.last_scalar_front = lattice.scalar(last_scalar_front[p]);
    layer.last_scalar_back = lattice.scalar(last_scalar_back[p]);
  }
  return layer;
}

/// Makes `layer` the current layer of a pixel.
void LayerSink::resume(std::size_t p, const integrals::OpenLayer& layer) {
  cut_[p] = layer;
  state_.red[p] = layer.red, state_.green[p] = layer.green, state_.blue[p] = layer.blue;
  state_.transmittance[p] = layer.transmittance;
  state_.first_back[p] = std::isinf(layer.front) ? WindowState::not_yet : 0;
  last_back[p] = WindowState::not_yet;
  const bool is_last = layers_.is_last(layer);
  end_at[p] = is_last ? -1 : end_transmittance_;
  least[p] = is_last ? layers_.integrator().termination_error() / scene_.left_out_per_transmittance : 0;
}

void LayerSink::add(std::span<const End> ends) {
  const scene::Lattice& lattice = scene_.lattice;
  batch_.reserve(ends.size());
  batch_.size = ends.size();
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const projection::LatticeSegment& s = ends[k].segment;
    batch_.length[k] = (lattice.depth(s.back) - lattice.depth(s.front)) * length_per_depth_[ends[k].pixel];
    batch_.scalar_front[k] = lattice.scalar(s.scalar_front);
    batch_.scalar_back[k] = lattice.scalar(s.scalar_back);
  }
  layers_.integrator().integrate(batch_);
  for (std::size_t k = 0; k < ends.size(); ++k) {
    const auto& [pixel, segment, light] = ends[k];
    integrals::OpenLayer layer = layer_of(pixel);
    ended_.clear();
    layers_.add({lattice.depth(segment.front), lattice.depth(segment.back), batch_.scalar_front[k],
                 batch_.scalar_back[k], batch_.length[k], light.own, light.white},
                batch_, k, layer, ended_);
    note_ended(pixel);
    resume(pixel, layer);
  }
}

void LayerSink::note_ended(std::uint32_t pixel) {
  for (const integrals::RayLayer& layer : ended_) made_.push_back({pixel, layer});
}

void LayerSink::finish() {
  segments_ += segments_here_;
  const auto n = static_cast<std::uint32_t>(rect_.area());
  for (std::uint32_t p = 0; p < n; ++p) {
    integrals::OpenLayer layer = layer_of(p);
    ended_.clear();
    layers_.end(layer, ended_);
    note_ended(p);
  }
  deliver_layers(rect_, made_, window_, *target_);
}

}  // namespace tessera::compositor
