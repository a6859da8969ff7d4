// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "integrals/ray_layers.hpp"
#include "scene/camera.hpp"
#include "scene/sample_source.hpp"
#include "scene/shading.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/settings.hpp"
#include "volume/precise/grid_surfaces.hpp"
#include "volume/precise/surface_walk.hpp"
#include "volume/precise/voxel_ray.hpp"
#include "volume/precise/voxel_shading.hpp"
#include "volume/precise/voxel_walk.hpp"

namespace tessera::volume {

struct VoxelLayersSettings {
  scene::Emission emission = scene::Emission::absorption;
  Peel peel;
  std::optional<scene::Shading> shading{};
  const GridSurfaces* surfaces = nullptr;  ///< null: no surfaces
};

/// Computes the layers of a grid's rays (integrals/ray_layers.hpp), along a VoxelWalk in double precision, for regular
/// and rectilinear grids with point or cell data. An object may be used by one thread only. A ray continues behind
/// opaque matter until its last layer is opaque, too, or until the ray ends.
class VoxelLayers final : public WalkSink {
 public:
  /// Source, function and surfaces must outlive this object.
  VoxelLayers(const scene::SampleSource& source, const scene::Camera& camera, const scene::TransferFunction& function,
              const VoxelLayersSettings& settings);

  /// Appends a ray's layers, front to back.
  void add(const VoxelRay& ray, std::vector<integrals::RayLayer>& layers);

  void enter(const VoxelStretch& stretch) override {
    if (shading_) light_ = shading_->light(stretch, ray_->step);
  }
  void line(double z0, double z1, double k_0, double k_1) override;
  [[nodiscard]] double transmittance() const override { return layers_.transmittance(open_); }

 private:
  static constexpr std::size_t together = 64;

  void put();
  [[nodiscard]] double least(const scene::SampleSource& source, const scene::TransferFunction& function,
                             const VoxelLayersSettings& settings) const;

  integrals::RayLayers layers_;
  VoxelWalk walk_;
  std::optional<VoxelShading> shading_;
  std::optional<SurfaceWalk> surfaces_;
  std::vector<SurfaceCrossing> crossings_;
  integrals::SegmentBatch batch_;
  std::vector<integrals::RayLayers::Stretch> stretches_;  ///< one for each element of the batch
  const VoxelRay* ray_ = nullptr;
  VoxelLight light_;
  integrals::OpenLayer open_;
  std::vector<integrals::RayLayer>* ended_ = nullptr;
};

}  // namespace tessera::volume
