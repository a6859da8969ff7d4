// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/voxel_layers.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tessera::volume {

VoxelLayers::VoxelLayers(const scene::SampleSource& source, const scene::Camera& camera,
                         const scene::TransferFunction& function, const VoxelLayersSettings& settings)
    : layers_(over_knot_numbers(function), settings.emission, settings.peel, true),
      walk_(source, function, {.emission = settings.emission, .least = least(source, function, settings)}) {
  if (settings.shading && source.geometry().association == scene::Association::point)
    shading_.emplace(*settings.shading, camera, source.geometry());
  if (settings.surfaces != nullptr && settings.surfaces->any()) surfaces_.emplace(source, *settings.surfaces);
  batch_.reserve(together);
  stretches_.reserve(together);
}

double VoxelLayers::least(const scene::SampleSource& source, const scene::TransferFunction& function,
                          const VoxelLayersSettings& settings) const {
  double color = function.max_color();
  if (settings.shading)
    color =
        std::max(color, color * (settings.shading->ambient + settings.shading->diffuse) + settings.shading->specular);
  const scene::Box box = scene::bounds(source.geometry());
  const double weight = integrals::opacity_weight(color, glm::length(box.high - box.low), settings.emission);
  const double of_surfaces = settings.surfaces != nullptr ? settings.surfaces->set().max_color() : 0;
  return layers_.integrator().termination_error() / std::max(weight, of_surfaces);
}

void VoxelLayers::add(const VoxelRay& ray, std::vector<integrals::RayLayer>& layers) {
  if (!(ray.begin < ray.end)) return;
  ray_ = &ray, ended_ = &layers;
  open_ = {};
  crossings_.clear();
  // All crossings are needed: a surface that is hidden from the eye may be visible in its layer.
  if (surfaces_) surfaces_->find(ray, 0, crossings_);
  VoxelRay part = ray;
  for (const SurfaceCrossing& crossing : crossings_) {
    part.end = crossing.z;
    walk_.walk(part, *this);
    put();
    layers_.add_surface(crossing.z, crossing.light, open_, layers);
    part.begin = crossing.z;
  }
  part.end = ray.end;
  walk_.walk(part, *this);
  put();
  layers_.end(open_, layers);
}

void VoxelLayers::line(double z0, double z1, double k_0, double k_1) {
  if (stretches_.size() == together) put();
  stretches_.push_back({z0, z1, k_0, k_1, (z1 - z0) * ray_->length_per_depth, light_.own, light_.white});
}

/// Integrates the collected lines and adds them to the layers.
void VoxelLayers::put() {
  batch_.size = stretches_.size();
  for (std::size_t n = 0; n < batch_.size; ++n) {
    batch_.length[n] = stretches_[n].length;
    batch_.scalar_front[n] = stretches_[n].scalar_front, batch_.scalar_back[n] = stretches_[n].scalar_back;
  }
  layers_.integrator().integrate(batch_);
  for (std::size_t n = 0; n < batch_.size; ++n) layers_.add(stretches_[n], batch_, n, open_, *ended_);
  stretches_.clear();
}

}  // namespace tessera::volume
