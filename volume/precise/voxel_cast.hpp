// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <vector>

#include "scene/camera.hpp"
#include "scene/pixel_rect.hpp"
#include "scene/sample_source.hpp"
#include "scene/shading.hpp"
#include "scene/transfer_function.hpp"
#include "volume/fragment_sink.hpp"
#include "volume/lane_error_bound.hpp"
#include "volume/precise/grid_surfaces.hpp"
#include "volume/precise/voxel_walk.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

struct VoxelCastSettings {
  WalkSettings walk;
  std::optional<scene::Shading> shading;
  std::vector<scene::HalfSpace> clip{};    ///< half-spaces to which rays are clipped
  const GridSurfaces* surfaces = nullptr;  ///< null: no surfaces
};

struct VoxelCastCounts {
  std::uint64_t rays = 0, voxels = 0, lines = 0, blocks_read = 0, bytes_read = 0;
};

/// The accumulated light of a ray, in double precision.
struct RaySum {
  double red = 0, green = 0, blue = 0, optical_depth = 0, transmittance = 1;
  double first = std::numeric_limits<double>::infinity();  ///< planar depth at which the light begins

  /// `bound` is the value for RayFragment::error_bound.
  [[nodiscard]] RayFragment fragment(int x, int y, double z_back, float bound) const;
};

/// Casts rays pixel by pixel along a VoxelWalk, integrating each linear piece exactly in double precision. There are
/// two kinds of such rays: those of rectilinear grids, which are not straight in index space, as the lane kernels
/// require; and those whose light in float lanes is uncertain (lane_error_bound.hpp). Surfaces are inserted between the
/// parts of rays that they separate.
///
/// Error     Below 1e-5 for any spacings, plus what the walk may omit (WalkSettings::tolerance, WalkSettings::least).
/// Bits      The bits of a ray depend only on the ray and on where it is divided.
/// Threads   Any number of threads may use one caster. Source, function and the objects that the settings refer to must
///           outlive the caster.
class VoxelCaster {
 public:
  /// Camera and size must be valid.
  VoxelCaster(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
              const scene::TransferFunction& function, const VoxelCastSettings& settings);
  ~VoxelCaster();
  VoxelCaster(const VoxelCaster&) = delete;
  VoxelCaster& operator=(const VoxelCaster&) = delete;

  /// Returns the ray through a pixel's centre.
  [[nodiscard]] VoxelRay ray(int x, int y) const;
  /// Returns the part of a ray in a chunk. Chunks that share a plane compute the same depth for this plane.
  [[nodiscard]] VoxelRay part_in(const VoxelBox& chunk, const VoxelRay& ray) const;
  /// Adds the light along `ray` behind the light in `sum`; does nothing if the ray is empty.
  void add(const VoxelRay& ray, RaySum& sum);

  /// Casts the rays of a region's pixels, limited to `part`, in rectangles of 32x32 pixels, which are reported to the
  /// sink when they are finished. Throws scene::FrameStopped after a request on `stop`. Uses the calling thread's
  /// arena, like cast() below.
  void cast(const VoxelBox& part, const scene::PixelRect& region, FragmentSink& sink, const std::stop_token& stop = {});
  void cast(std::span<const UncertainRay> rays, FragmentSink& sink, const std::stop_token& stop = {});

  [[nodiscard]] VoxelCastCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns an upper bound of the number of lattice planes that a ray crosses. This is the cost of casting the ray's
/// pixel if everything is visible.
double planes_crossed(const VoxelRay& ray, const scene::GridGeometry& geometry);

}  // namespace tessera::volume
