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
  std::vector<scene::HalfSpace> clip{};    ///< that rays are kept in
  const GridSurfaces* surfaces = nullptr;  ///< in the volume; null: none
};

struct VoxelCastCounts {
  std::uint64_t rays = 0, voxels = 0, lines = 0, blocks_read = 0, bytes_read = 0;
};

/// What a ray has gathered, in double precision.
struct RaySum {
  double red = 0, green = 0, blue = 0, optical_depth = 0, transmittance = 1;
  double first = std::numeric_limits<double>::infinity();  ///< planar depth where it begins

  /// `bound`: RayFragment::error_bound.
  [[nodiscard]] RayFragment fragment(int x, int y, double z_back, float bound) const;
};

/// Casts rays pixel by pixel along a VoxelWalk, each line integrated exactly in double precision: those of rectilinear
/// grids, which are not straight in index space, so that the caster's lanes are of no use, and those of which float
/// lanes are not sure (lane_error_bound.hpp). Surfaces are put between the parts of rays that they divide.
///
/// Error    below 1e-5, whatever the spacings; what the walk may leave out (WalkSettings::tolerance, least) comes on
///          top.
/// Bits     of a ray depend on nothing but itself and where it is cut.
/// Threads  any number may use one caster. Source, function and what the settings point to must outlive it.
class VoxelCaster {
 public:
  /// A valid camera and size.
  VoxelCaster(const scene::SampleSource& source, const scene::Camera& camera, scene::ImageSize size,
              const scene::TransferFunction& function, const VoxelCastSettings& settings);
  ~VoxelCaster();
  VoxelCaster(const VoxelCaster&) = delete;
  VoxelCaster& operator=(const VoxelCaster&) = delete;

  /// The ray through a pixel's centre.
  [[nodiscard]] VoxelRay ray(int x, int y) const;
  /// The part of a ray in a chunk. Chunks that share a plane find it at the same depth.
  [[nodiscard]] VoxelRay part_in(const VoxelBox& chunk, const VoxelRay& ray) const;
  /// Adds what `ray` meets behind what `sum` has; nothing if it is empty.
  void add(const VoxelRay& ray, RaySum& sum);

  /// The rays of the pixels of a region, so far as they are in `part`, by rectangles of 32x32 that the sink hears of as
  /// they are finished. Throws scene::FrameStopped once `stop` is asked for. Uses the calling thread's arena, as cast()
  /// below does.
  void cast(const VoxelBox& part, const scene::PixelRect& region, FragmentSink& sink, const std::stop_token& stop = {});
  void cast(std::span<const UncertainRay> rays, FragmentSink& sink, const std::stop_token& stop = {});

  [[nodiscard]] VoxelCastCounts counts() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Planes of the lattice that a ray crosses, at most: what the cast of its pixel costs where everything shows.
double planes_crossed(const VoxelRay& ray, const scene::GridGeometry& geometry);

}  // namespace tessera::volume
