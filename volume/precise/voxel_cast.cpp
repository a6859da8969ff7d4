// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/voxel_cast.hpp"

#include <tbb/blocked_range.h>
#include <tbb/blocked_range2d.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "integrals/segment_batch.hpp"
#include "integrals/segment_integrator.hpp"
#include "scene/frame_watch.hpp"
#include "volume/precise/surface_walk.hpp"
#include "volume/precise/voxel_shading.hpp"

namespace tessera::volume {
namespace {

/// One thread's caster of pixels.
class VoxelPixels final : public WalkSink {
 public:
  VoxelPixels(const scene::SampleSource& source, const scene::Camera& camera, const scene::TransferFunction& function,
              const VoxelCastSettings& settings)
      : integrator_(over_knot_numbers(function), {.kind = scene::IntegratorKind::exact}, settings.walk.emission),
        walk_(source, function, settings.walk) {
    if (settings.shading && source.geometry().association == scene::Association::point)
      shading_.emplace(*settings.shading, camera, source.geometry());
    batch_.reserve(together);
    lights_.resize(together);
    places_.resize(together);
    if (settings.surfaces != nullptr) surfaces_.emplace(source, *settings.surfaces);
    least_ = settings.walk.least;
  }

  /// Adds the light along a ray behind the light in `sum`.
  void add(const VoxelRay& ray, RaySum& sum) {
    if (!(ray.begin < ray.end)) return;
    ++counts_.rays;
    ray_ = &ray;
    sum_ = sum;
    batch_.size = 0;
    crossings_.clear();
    const bool stops = surfaces_ && surfaces_->find(ray, least_, crossings_);
    VoxelRay part = ray;
    for (const SurfaceCrossing& crossing : crossings_) {
      part.end = crossing.z;
      walk_.walk(part, *this);
      put();
      put(crossing);
      part.begin = crossing.z;
    }
    part.end = ray.end;
    if (!stops) walk_.walk(part, *this);
    put();
    sum = sum_;
  }

  void enter(const VoxelStretch& stretch) override {
    if (shading_) light_ = shading_->light(stretch, ray_->step);
  }
  void line(double z0, double z1, double k_0, double k_1) override {
    if (batch_.size == together) put();
    const std::size_t n = batch_.size++;
    batch_.length[n] = (z1 - z0) * ray_->length_per_depth;
    batch_.scalar_front[n] = k_0, batch_.scalar_back[n] = k_1;
    lights_[n] = light_, places_[n] = {z0, z1};
  }
  [[nodiscard]] double transmittance() const override { return sum_.transmittance; }

  [[nodiscard]] VoxelCastCounts counts() const {
    VoxelCastCounts counts = counts_;
    counts.voxels = walk_.counts().voxels;
    counts.blocks_read = walk_.counts().blocks_read, counts.bytes_read = walk_.counts().bytes_read;
    return counts;
  }

 private:
  static constexpr std::size_t together = 64;

  /// Integrates the collected lines and adds their light behind the accumulated light.
  void put() {
    integrator_.integrate(batch_);
    for (std::size_t n = 0; n < batch_.size; ++n) {
      const VoxelLight& light = lights_[n];
      const double white = light.white > 0 ? -light.white * std::expm1(-batch_.optical_depth[n]) : 0;
      sum_.red += sum_.transmittance * (light.own * batch_.red[n] + white);
      sum_.green += sum_.transmittance * (light.own * batch_.green[n] + white);
      sum_.blue += sum_.transmittance * (light.own * batch_.blue[n] + white);
      sum_.optical_depth += batch_.optical_depth[n];
      sum_.transmittance *= batch_.transmittance[n];
      if (std::isinf(sum_.first) && batch_.optical_depth[n] > 0)
        if (const auto u = integrator_.first_visible(batch_.scalar_front[n], batch_.scalar_back[n]))
          sum_.first = places_[n][0] + (places_[n][1] - places_[n][0]) * *u;
    }
    counts_.lines += batch_.size;
    batch_.size = 0;
  }

  void put(const SurfaceCrossing& crossing) {
    const scene::SurfaceSet::Light& light = crossing.light;
    sum_.red += sum_.transmittance * light.red;
    sum_.green += sum_.transmittance * light.green;
    sum_.blue += sum_.transmittance * light.blue;
    sum_.optical_depth -= std::log1p(-light.opacity);
    sum_.transmittance *= 1 - light.opacity;
    if (std::isinf(sum_.first)) sum_.first = crossing.z;
  }

  integrals::SegmentIntegrator integrator_;
  std::optional<VoxelShading> shading_;
  std::optional<SurfaceWalk> surfaces_;
  double least_ = 0;
  std::vector<SurfaceCrossing> crossings_;
  VoxelWalk walk_;
  integrals::SegmentBatch batch_;
  std::vector<VoxelLight> lights_;
  std::vector<std::array<double, 2>> places_;
  const VoxelRay* ray_ = nullptr;
  VoxelLight light_;
  RaySum sum_;
  VoxelCastCounts counts_;
};

}  // namespace

RayFragment RaySum::fragment(int x, int y, double z_back, float bound) const {
  const auto channel = [](double v) { return static_cast<float>(std::max(0.0, v)); };
  return {x,
          y,
          static_cast<float>(first),
          static_cast<float>(z_back),
          channel(red),
          channel(green),
          channel(blue),
          channel(-std::expm1(-optical_depth)),
          bound};
}

struct VoxelCaster::State {
  State(const scene::SampleSource& source, const scene::Camera& camera_, scene::ImageSize size,
        const scene::TransferFunction& function_, const VoxelCastSettings& settings_)
      : geometry(source.geometry()),
        camera(camera_),
        function(function_),
        settings(settings_),
        rays(camera_, size, source.geometry(), settings.clip),
        pixels([this, &source] { return std::make_unique<VoxelPixels>(source, camera, function, settings); }) {}

  const scene::GridGeometry& geometry;
  const scene::Camera camera;
  const scene::TransferFunction& function;
  const VoxelCastSettings settings;
  VoxelRays rays;
  tbb::enumerable_thread_specific<std::unique_ptr<VoxelPixels>> pixels;
};

VoxelCaster::VoxelCaster(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
                         const scene::TransferFunction& function, const VoxelCastSettings& settings)
    : state_(std::make_unique<State>(source, camera, size, function, settings)) {}
VoxelCaster::~VoxelCaster() = default;

VoxelRay VoxelCaster::ray(int x, int y) const { return state_->rays.ray(x + 0.5, y + 0.5); }

VoxelRay VoxelCaster::part_in(const VoxelBox& chunk, const VoxelRay& ray) const {
  const scene::GridGeometry& geometry = state_->geometry;
  VoxelRay part = ray;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const std::int64_t last = geometry.points[a] - 1;
    const double low = geometry.lattice(a, chunk.low[a]), high = geometry.lattice(a, chunk.high[a]);
    if (ray.step[axis] == 0) {
      const double place = ray.origin[axis] + ray.aside[axis];
      if (place < low || (place >= high && chunk.high[a] < last)) part.end = part.begin;
      continue;
    }
    const bool up = ray.step[axis] > 0;
    const double at_low = (low - ray.origin[axis]) / ray.step[axis],
                 at_high = (high - ray.origin[axis]) / ray.step[axis];
    // The ray already ends at the volume's first and last planes.
    if (chunk.low[a] > 0) (up ? part.begin : part.end) = up ? std::max(part.begin, at_low) : std::min(part.end, at_low);
    if (chunk.high[a] < last)
      (up ? part.end : part.begin) = up ? std::min(part.end, at_high) : std::max(part.begin, at_high);
  }
  return part;
}

void VoxelCaster::add(const VoxelRay& ray, RaySum& sum) { state_->pixels.local()->add(ray, sum); }

void VoxelCaster::cast(const VoxelBox& part, const scene::PixelRect& region, FragmentSink& sink,
                       const std::stop_token& stop) {
  if (region.empty()) return;
  constexpr int side = 32;
  tbb::parallel_for(tbb::blocked_range2d<int>(region.y0, region.y1, side, region.x0, region.x1, side),
                    [&](const auto& tile) {
                      scene::throw_if_stopped(stop);
                      std::vector<RayFragment> fragments;
                      for (int y = tile.rows().begin(); y != tile.rows().end(); ++y)
                        for (int x = tile.cols().begin(); x != tile.cols().end(); ++x) {
                          const VoxelRay through = part_in(part, ray(x, y));
                          if (!(through.begin < through.end)) continue;
                          RaySum sum;
                          add(through, sum);
                          fragments.push_back(sum.fragment(x, y, through.end, 0));
                        }
                      sink.take(fragments);
                      sink.finished({tile.cols().begin(), tile.rows().begin(), tile.cols().end(), tile.rows().end()});
                    });
}

void VoxelCaster::cast(std::span<const UncertainRay> rays, FragmentSink& sink, const std::stop_token& stop) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, rays.size(), 16), [&](const auto& some) {
    scene::throw_if_stopped(stop);
    std::vector<RayFragment> fragments;
    for (std::size_t n = some.begin(); n != some.end(); ++n) {
      VoxelRay through = ray(rays[n].x, rays[n].y);
      through.begin = std::max(through.begin, rays[n].z_begin), through.end = std::min(through.end, rays[n].z_end);
      if (!(through.begin < through.end)) continue;
      RaySum sum;
      add(through, sum);
      fragments.push_back(sum.fragment(rays[n].x, rays[n].y, through.end, rays[n].error_bound));
    }
    sink.take(fragments);
  });
}

VoxelCastCounts VoxelCaster::counts() const {
  VoxelCastCounts sum;
  for (const auto& mine : state_->pixels) {
    const VoxelCastCounts c = mine->counts();
    sum.rays += c.rays, sum.voxels += c.voxels, sum.lines += c.lines;
    sum.blocks_read += c.blocks_read, sum.bytes_read += c.bytes_read;
  }
  return sum;
}

double planes_crossed(const VoxelRay& ray, const scene::GridGeometry& geometry) {
  if (!(ray.begin < ray.end)) return 0;
  double planes = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const int axis = static_cast<int>(a);
    const auto index = [&](double z) {
      const double local = ray.origin[axis] + z * ray.step[axis];
      const auto& list = geometry.coordinates[a];
      return list.empty() ? local / geometry.spacing[axis]
                          : static_cast<double>(std::lower_bound(list.begin(), list.end(), local) - list.begin());
    };
    planes += std::abs(index(ray.end) - index(ray.begin));
  }
  return planes;
}

}  // namespace tessera::volume
