#pragma once

#include <array>
#include <optional>
#include <span>

#include "scene/camera.hpp"
#include "scene/frame_watch.hpp"
#include "scene/image.hpp"
#include "scene/optical_model.hpp"
#include "scene/sample_source.hpp"
#include "scene/shading.hpp"
#include "scene/transfer_function.hpp"
#include "volume/render.hpp"
#include "volume/voxel_walk.hpp"

namespace tessera::volume {

/// Pictures of rectilinear grids, whose rays are not straight in index space, so that the caster's lanes are of no use,
/// and pixels of which float lanes are not sure (lane_error_bound.hpp): pixel by pixel along a VoxelWalk, each line
/// integrated exactly in double precision.
///
/// Error   below 1e-5, whatever the spacings; what the walk may leave out (WalkSettings::tolerance, least) comes on
///         top.
/// Bits    of a pixel depend on nothing but itself.
struct VoxelCastSettings {
  WalkSettings walk;
  std::optional<scene::Shading> shading;
};

struct VoxelCastCounts {
  std::uint64_t rays = 0, voxels = 0, lines = 0, blocks_read = 0, bytes_read = 0;
};

/// Fills the pixels of `region` in `image`. Uses the calling thread's arena. `watch` hears of finished rectangles and
/// is asked for a stop at each, see volume::Renderer::render.
VoxelCastCounts cast_voxel_by_voxel(const scene::SampleSource& source, const scene::Camera& camera,
                                    const scene::TransferFunction& function, const VoxelCastSettings& settings,
                                    const scene::PixelRect& region, scene::Image& image, scene::FrameWatch& watch);

/// Casts the pixels (x, y) of a list anew, in place of what `image` has there. Throws scene::FrameStopped once `stop`
/// is asked for.
VoxelCastCounts cast_voxel_by_voxel(const scene::SampleSource& source, const scene::Camera& camera,
                                    const scene::TransferFunction& function, const VoxelCastSettings& settings,
                                    std::span<const std::array<int, 2>> pixels, scene::Image& image,
                                    const std::stop_token& stop = {});

/// Planes of the lattice that a ray crosses, at most: what the cast of its pixel costs where everything shows.
double planes_crossed(const VoxelRay& ray, const scene::GridGeometry& geometry);

}  // namespace tessera::volume
