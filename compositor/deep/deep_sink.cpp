// SPDX-License-Identifier: BSD-3-Clause
#include "compositor/deep/deep_sink.hpp"

#include <cmath>

#include "compositor/finite_float.hpp"

namespace tessera::compositor {
namespace {

/// Number of pieces that are integrated together: they fit into a core's second-level cache.
constexpr std::size_t batch_pieces = 8192;

}  // namespace

void append_tidy(const scene::DeepImageSample& sample, std::size_t first, std::vector<scene::DeepImageSample>& to) {
  if (sample.alpha == 0 && sample.red == 0 && sample.green == 0 && sample.blue == 0) return;
  if (to.size() > first) {
    scene::DeepImageSample& last = to.back();
    if (sample.z == sample.z_back && last.z == last.z_back && sample.z == last.z) {
      const float through = 1 - last.alpha;
      last.red += through * sample.red;
      last.green += through * sample.green;
      last.blue += through * sample.blue;
      last.alpha += through * sample.alpha;
      return;
    }
  }
  to.push_back(sample);
}

void append_tidy(std::span<const DeepSample> samples, std::vector<scene::DeepImageSample>& to) {
  const std::size_t first = to.size();
  for (const DeepSample& s : samples)
    append_tidy({finite_float(s.front), finite_float(s.back), finite_float(s.light[0]), finite_float(s.light[1]),
                 finite_float(s.light[2]), static_cast<float>(-std::expm1(-s.optical_depth))},
                first, to);
}

DeepSink::DeepSink(const TileScene& scene, const ImageWindow& window, const scene::TransferFunction& function,
                   scene::Emission emission, double accuracy, DeepTarget& collector)
    : scene_(scene),
      window_(window),
      cutter_(scene.light != nullptr ? projection::brightest(scene.light->shading(), function) : function, emission,
              accuracy),
      accuracy_(accuracy),
      collector_(&collector) {}

void DeepSink::start(const scene::PixelRect& rect) {
  rect_ = rect;
  segments_here_ = 0;
  const auto n = static_cast<std::size_t>(rect.area());
  mergers_.assign(n, DeepMerger(accuracy_));
  transmittance_before_.assign(n, 1.0);
  rays_.assign(n, {});
  open_.assign(n, 1);
  open_count_ = n;
  length_per_depth_.resize(n);
  std::size_t i = 0;
  for (int y = rect.y0; y < rect.y1; ++y)
    for (int x = rect.x0; x < rect.x1; ++x) length_per_depth_[i++] = scene_.space->length_per_depth(x + 0.5, y + 0.5);
  samples_.clear();
}

void DeepSink::take(Store& lists, double final_depth, std::size_t /*at_least*/, scene::StageTimer& timer) {
  lists.sort();
  timer.record("sort");
  const projection::RaySegments& segments = lists.segments;
  for (std::uint32_t p = 0; p < open_.size(); ++p) {
    if (!open_[p]) continue;
    for (const auto& entry : lists.pixel(p)) {
      if (!(entry.depth < final_depth)) break;
      const std::uint32_t i = entry.segment;
      if (scene_.surfaces != nullptr && projection::is_crossing(segments.scalar_front[i])) {
        add_crossing(p, segments.front[i], projection::crossing_of(segments.scalar_front[i]), segments.scalar_back[i]);
        continue;
      }
      cutter_.cut({segments.front[i], segments.back[i], segments.scalar_front[i], segments.scalar_back[i]},
                  length_per_depth_[p], transmittance_before_[p], pieces_);
      piece_pixels_.resize(pieces_.size(), p);
      if (scene_.light != nullptr) piece_tets_.resize(pieces_.size(), segments.tet(i));
      if (pieces_.size() >= batch_pieces) integrate_pieces(timer);
    }
  }
  integrate_pieces(timer);
  segments_here_ += lists.remove(final_depth, open_);
  timer.record("composite");
}

/// Adds the crossing of a surface to the list of pieces, as a piece of length zero. The pieces of each pixel are in
/// order of depth.
void DeepSink::add_crossing(std::uint32_t pixel, double depth, const projection::Crossing& crossing, double value) {
  crossings_.push_back({pieces_.size(), crossing, value});
  pieces_.push_back({depth, depth, 0, 0});
  piece_pixels_.push_back(pixel);
  if (scene_.light != nullptr) piece_tets_.push_back(0);
  transmittance_before_[pixel] *= 1 - scene_.surfaces->light(crossing.number, crossing.cosine).opacity;
}

void DeepSink::integrate_pieces(scene::StageTimer& timer) {
  timer.record("composite");
  batch_.reserve(pieces_.size());
  batch_.size = pieces_.size();
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    batch_.length[k] = (pieces_[k].back - pieces_[k].front) * length_per_depth_[piece_pixels_[k]];
    batch_.scalar_front[k] = pieces_[k].scalar_front;
    batch_.scalar_back[k] = pieces_[k].scalar_back;
  }
  scene_.integrator->integrate(batch_);
  for (std::size_t k = 0; k < piece_tets_.size(); ++k) {
    if (!(pieces_[k].optical_depth > 0)) continue;
    const auto p = static_cast<int>(piece_pixels_[k]);
    const int x = rect_.x0 + p % rect_.width(), y = rect_.y0 + p / rect_.width();
    const glm::dvec3 ray = scene_.space->direction(x + 0.5, y + 0.5);
    light_segment(scene_.light->on(scene_.normals->of(piece_tets_[k]), ray), k, pieces_[k].optical_depth, batch_);
  }
  if (!crossings_.empty()) {
    light_crossings(*scene_.surfaces, crossings_, batch_);
    for (const CrossingInBatch& c : crossings_) pieces_[c.at].optical_depth = batch_.optical_depth[c.at];
  }
  timer.record("integrate");
  auto next = crossings_.cbegin();
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const std::uint32_t p = piece_pixels_[k];
    const bool surface = next != crossings_.end() && next->at == k;
    if (surface) ++next;
    if (!open_[p]) continue;
    DeepMerger& merger = mergers_[p];
    Ray& ray = rays_[p];
    if (ray.optical_depth == 0 && pieces_[k].optical_depth > 0) ray.depth = pieces_[k].front;
    const double through = merger.transmittance();
    ray.red += through * batch_.red[k];
    ray.green += through * batch_.green[k];
    ray.blue += through * batch_.blue[k];
    ray.optical_depth += pieces_[k].optical_depth;
    ended_.clear();
    merger.add(
        {pieces_[k].front, pieces_[k].back, {batch_.red[k], batch_.green[k], batch_.blue[k]}, pieces_[k].optical_depth},
        ended_, surface);
    for (const DeepSample& sample : ended_) samples_.push_back({p, sample});
    if (merger.transmittance() * scene_.left_out_per_transmittance < scene_.integrator->termination_error()) {
      open_[p] = 0;
      --open_count_;
    }
  }
  pieces_.clear();
  piece_pixels_.clear();
  piece_tets_.clear();
  crossings_.clear();
}

void DeepSink::finish() {
  segments_ += segments_here_;
  const auto n = static_cast<std::uint32_t>(rect_.area());
  for (std::uint32_t p = 0; p < n; ++p) {
    const Ray& ray = rays_[p];
    const auto x = static_cast<int>(p) % rect_.width(), y = static_cast<int>(p) / rect_.width();
    window_.put(rect_.x0 + x, rect_.y0 + y, {ray.red, ray.green, ray.blue, -std::expm1(-ray.optical_depth), ray.depth});
  }
  for (std::uint32_t p = 0; p < n; ++p) {
    ended_.clear();
    mergers_[p].end(ended_);
    for (const DeepSample& sample : ended_) samples_.push_back({p, sample});
  }
  std::stable_sort(samples_.begin(), samples_.end(),
                   [](const PixelSample& a, const PixelSample& b) { return a.pixel < b.pixel; });
  std::vector<std::uint32_t> counts(n, 0);
  std::vector<scene::DeepImageSample> tidy;
  for (auto first = samples_.begin(); first != samples_.end();) {
    const std::uint32_t p = first->pixel;
    ended_.clear();
    for (; first != samples_.end() && first->pixel == p; ++first) ended_.push_back(first->sample);
    const std::size_t before = tidy.size();
    append_tidy(ended_, tidy);
    counts[p] = static_cast<std::uint32_t>(tidy.size() - before);
  }
  collector_->add(rect_, std::move(counts), std::move(tidy));
}

}  // namespace tessera::compositor
