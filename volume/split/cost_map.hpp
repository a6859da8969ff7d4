// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/split/image_split.hpp"
#include "volume/split/learned_work.hpp"
#include "volume/split/voxel_box.hpp"

namespace tessera::volume {

/// How the cost of a pixel is computed: from the cells that the caster visits, or from the visible bricks behind the
/// pixel (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 4.1).
enum class CostMethod {
  visited,   ///< each ray's path through the cells that the caster visits
  accurate,  ///< each ray's path through the bricks
  backface,  ///< only the back faces of bricks: each corner has a weight, which is linear between corners
  splatting  ///< a sphere around each brick
};

/// Cells of 8^3 voxels (CellRanges) and their visibility under the transfer function.
struct VisibleCells {
  scene::GridIndex cells;
  std::span<const std::uint8_t> visible;  ///< one byte per cell
};

/// A brick in index space.
struct CostBox {
  glm::dvec3 low, high;
};

struct CostSettings {
  CostMethod method = CostMethod::visited;
  double resolution = 0.5;  ///< map pixels per image pixel along each axis, in (0, 1]; 0.5 is the thesis's "quarter"
  /// The cost of a part of a ray is the number of voxels that it crosses (exact integrals); if false, its length
  /// (samples at steps).
  bool by_voxels = true;
  /// Only for `visited`. If not null, the cost is the samples per slab as learned by a pilot pass, and rays end where
  /// they are opaque.
  const WorkRates* learned = nullptr;
  double length_unit = 1;                    ///< length unit of the learned optical depths, in world units
  double most_depth = 1e9;                   ///< optical depth at which rays end
  std::optional<scene::PixelRect> region{};  ///< in map pixels; default: the whole map
};

scene::ImageSize map_size(scene::ImageSize image, double resolution);

/// The image pixels that the volume may cover; all pixels if it extends behind the eye.
scene::PixelRect footprint(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry);
/// The image pixels that a part of the volume may cover.
scene::PixelRect footprint(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                           const VoxelBox& part);

/// Computes the cost of the map's pixels, in 1/64 voxels (or mean voxel sides).
///
/// `visited` marches the ray of each map pixel's centre like the caster: eight slabs of voxels at a time, which count
/// if a packet of 4 x 4 pixels around the ray may meet a visible cell in them. With learned rates, samples count
/// instead of voxels, until the ray is opaque. The other methods sum over `bricks`. `accurate` uses the ray of each map
/// pixel's centre. The two remaining methods are approximations that give each brick its exact total for the depth of
/// its centre: `backface` gives a corner the weight 1 inside the brick's outline and 0.25 on the outline, and divides
/// faces into two triangles through the inner corner (Moloney 2008, A.4); `splatting` uses the chords of a sphere as
/// wide as the brick. For bricks that extend behind the eye, each ray's path through the brick is used instead.
///
/// Throws Error(bad_input) for a resolution out of range. Uses the calling thread's arena.
CostMap cost_map(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                 const VisibleCells& cells, std::span<const CostBox> bricks, const CostSettings& settings);

}  // namespace tessera::volume
