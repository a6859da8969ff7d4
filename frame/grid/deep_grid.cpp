// SPDX-License-Identifier: BSD-3-Clause
#include "frame/grid/deep_grid.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "compositor/deep/deep_collector.hpp"
#include "compositor/deep/deep_fragments.hpp"
#include "compositor/deep/deep_pieces.hpp"
#include "compositor/deep/deep_sink.hpp"
#include "compositor/deep/peel_sink.hpp"
#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "scene/frame_watch.hpp"
#include "scene/threads.hpp"
#include "volume/precise/surface_walk.hpp"
#include "volume/precise/voxel_layers.hpp"
#include "volume/precise/voxel_walk.hpp"

namespace tessera::frame {
namespace {

/// Renders pixels on one thread.
class PixelSamples {
 public:
  virtual ~PixelSamples() = default;
  /// Appends the pixel's samples.
  virtual void add(const volume::VoxelRay& ray, std::vector<scene::DeepImageSample>& to) = 0;
};

/// Renders pixels whose samples are layers.
class LayerPixels final : public PixelSamples {
 public:
  LayerPixels(const scene::SampleSource& source, const scene::Camera& camera, const scene::TransferFunction& function,
              const DeepSettings& settings)
      : rays_(source, camera, function,
              {settings.emission, *settings.frame.peel, settings.grid.shading, settings.surfaces_of_grid}) {}

  void add(const volume::VoxelRay& ray, std::vector<scene::DeepImageSample>& to) override {
    layers_.clear();
    rays_.add(ray, layers_);
    compositor::append_layers(layers_, to);
  }

 private:
  volume::VoxelLayers rays_;
  std::vector<integrals::RayLayer> layers_;
};

/// Renders pixels whose samples may be cut.
class DeepPixels final : public PixelSamples, public volume::WalkSink {
 public:
  DeepPixels(const scene::SampleSource& source, const scene::TransferFunction& function, const DeepSettings& settings)
      : cutter_(volume::over_knot_numbers(function), settings.emission, settings.frame.deep_accuracy),
        integrator_(volume::over_knot_numbers(function), {.kind = scene::IntegratorKind::exact}, settings.emission),
        accuracy_(settings.frame.deep_accuracy),
        least_(least(source, function, settings)),
        walk_(source, function, {.emission = settings.emission, .least = least_}) {
    if (settings.surfaces_of_grid != nullptr && settings.surfaces_of_grid->any())
      surfaces_.emplace(source, *settings.surfaces_of_grid);
  }

  void add(const volume::VoxelRay& ray, std::vector<scene::DeepImageSample>& to) override {
    pieces_.clear();
    transmittance_ = 1;
    length_per_depth_ = ray.length_per_depth;
    go_along(ray);
    batch_.reserve(pieces_.size());
    batch_.size = pieces_.size();
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      batch_.length[k] = (pieces_[k].back - pieces_[k].front) * ray.length_per_depth;
      batch_.scalar_front[k] = pieces_[k].scalar_front;
      batch_.scalar_back[k] = pieces_[k].scalar_back;
    }
    integrator_.integrate(batch_);
    compositor::DeepMerger merger(accuracy_);
    samples_.clear();
    auto next = met_.cbegin();
    for (std::size_t k = 0; k < pieces_.size(); ++k) {
      const bool surface = next != met_.cend() && next->piece == k;
      if (surface) {
        const scene::SurfaceSet::Light& light = (next++)->light;
        // The optical depth of an opaque surface is infinite.
        merger.add(
            {pieces_[k].front, pieces_[k].back, {light.red, light.green, light.blue}, -std::log1p(-light.opacity)},
            samples_, true);
        continue;
      }
      merger.add({pieces_[k].front,
                  pieces_[k].back,
                  {batch_.red[k], batch_.green[k], batch_.blue[k]},
                  pieces_[k].optical_depth},
                 samples_);
    }
    merger.end(samples_);
    compositor::append_tidy(samples_, to);
  }

  void enter(const volume::VoxelStretch& /*stretch*/) override {}
  void line(double z0, double z1, double k_0, double k_1) override {
    cutter_.cut({z0, z1, k_0, k_1}, length_per_depth_, transmittance_, pieces_);
  }
  [[nodiscard]] double transmittance() const override { return transmittance_; }

 private:
  /// A surface and its position among the pieces.
  struct Met {
    std::size_t piece;
    scene::SurfaceSet::Light light;
  };

  /// Computes the pieces along a ray, and for each surface its index among them.
  void go_along(const volume::VoxelRay& ray) {
    crossings_.clear();
    met_.clear();
    const bool stops = surfaces_ && surfaces_->find(ray, least_, crossings_);
    volume::VoxelRay part = ray;
    for (const volume::SurfaceCrossing& crossing : crossings_) {
      part.end = crossing.z;
      walk_.walk(part, *this);
      if (transmittance_ < least_) return;
      met_.push_back({pieces_.size(), crossing.light});
      pieces_.push_back({crossing.z, crossing.z, 0, 0});
      transmittance_ *= 1 - crossing.light.opacity;
      part.begin = crossing.z;
    }
    part.end = ray.end;
    if (!stops) walk_.walk(part, *this);
  }

  double least(const scene::SampleSource& source, const scene::TransferFunction& function,
               const DeepSettings& settings) const {
    const scene::Box box = scene::bounds(source.geometry());
    return integrator_.termination_error() /
           std::max(integrals::opacity_weight(function.max_color(), glm::length(box.high - box.low), settings.emission),
                    settings.surfaces_of_grid != nullptr ? settings.surfaces_of_grid->set().max_color() : 0);
  }

  compositor::PieceCutter cutter_;
  integrals::SegmentIntegrator integrator_;
  double accuracy_, least_, transmittance_ = 1, length_per_depth_ = 1;
  volume::VoxelWalk walk_;
  std::optional<volume::SurfaceWalk> surfaces_;
  std::vector<volume::SurfaceCrossing> crossings_;
  std::vector<Met> met_;
  std::vector<compositor::DeepPiece> pieces_;
  integrals::SegmentBatch batch_;
  std::vector<compositor::DeepSample> samples_;
};

}  // namespace

scene::DeepImage deep_image(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                            const scene::TransferFunction& function, const DeepSettings& settings, int y0, int y1,
                            const std::stop_token& stop) {
  scene::validate(camera);
  scene::validate(size);
  const volume::VoxelRays rays(camera, size, source.geometry(), settings.clip);
  compositor::DeepCollector collector(size, settings.memory_bytes / 2);
  tbb::task_arena arena(scene::threads_for(settings.threads));
  arena.execute([&] {
    tbb::enumerable_thread_specific<std::unique_ptr<PixelSamples>> pixels([&]() -> std::unique_ptr<PixelSamples> {
      if (settings.frame.peel) return std::make_unique<LayerPixels>(source, camera, function, settings);
      return std::make_unique<DeepPixels>(source, function, settings);
    });
    constexpr int side = 32;
    const int across = (size.width + side - 1) / side, down = (std::max(0, y1 - y0) + side - 1) / side;
    tbb::parallel_for(0, across * down, [&](int tile) {
      scene::PixelRect rect{tile % across * side, y0 + tile / across * side, 0, 0};
      rect.x1 = std::min(rect.x0 + side, size.width), rect.y1 = std::min(rect.y0 + side, y1);
      std::vector<std::uint32_t> counts;
      std::vector<scene::DeepImageSample> samples;
      for (int y = rect.y0; y < rect.y1; ++y) {
        scene::throw_if_stopped(stop);
        for (int x = rect.x0; x < rect.x1; ++x) {
          const std::size_t before = samples.size();
          pixels.local()->add(rays.ray(x + 0.5, y + 0.5), samples);
          counts.push_back(static_cast<std::uint32_t>(samples.size() - before));
        }
      }
      collector.add(rect, std::move(counts), std::move(samples));
    });
  });
  return collector.image();
}

}  // namespace tessera::frame
