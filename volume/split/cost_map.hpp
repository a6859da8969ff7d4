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

/// How the cost of a pixel is found: from the cells that the caster visits, or from the visible bricks behind the pixel
/// (Moloney, "Ray Coherence in Parallel Volume Rendering", SFU 2008, 4.1).
enum class CostMethod {
  visited,   ///< each ray's way through what the caster visits of it
  accurate,  ///< each ray's way through the bricks
  backface,  ///< back faces of bricks alone, a weight at each corner, linear between
  splatting  ///< a sphere round each brick
};

/// Cells of 8^3 voxels (CellRanges) and which of them the transfer function shows.
struct VisibleCells {
  scene::GridIndex cells;
  std::span<const std::uint8_t> visible;  ///< one byte a cell
};

/// A brick, in index space.
struct CostBox {
  glm::dvec3 low, high;
};

struct CostSettings {
  CostMethod method = CostMethod::visited;
  double resolution = 0.5;  ///< map pixels an image pixel along each axis, in (0, 1]; 0.5 is the thesis's "quarter"
  /// What a stretch of ray costs: the voxels it crosses (exact integrals), or else its length (samples at steps).
  bool by_voxels = true;
  /// visited, not null: samples a slab as a pilot pass has taught, and rays end where they let nothing through.
  const WorkRates* learned = nullptr;
  double length_unit = 1;                    ///< world units, of the optical depths learned
  double most_depth = 1e9;                   ///< optical depth at which rays end
  std::optional<scene::PixelRect> region{};  ///< map pixels; none: all
};

/// Size of the map of an image.
scene::ImageSize map_size(scene::ImageSize image, double resolution);

/// The image pixels that the volume may cover; all of them if it reaches behind the eye.
scene::PixelRect footprint(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry);
/// The same of a part of it.
scene::PixelRect footprint(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                           const VoxelBox& part);

/// The cost of the map's pixels, in 1/64 voxels (or mean voxel sides).
///
/// `visited` marches the ray of each map pixel's centre as the caster does: eight slabs of voxels at a time, which
/// count if a packet of 4 x 4 pixels round the ray may meet a visible cell in them; with what was learned, samples
/// count instead of voxels, until the ray is dark. The others sum over `bricks`: `accurate` by the ray of each map
/// pixel's centre; the approximations give each brick its true total by the depth of its centre: `backface` counts a
/// corner 1 inside the brick's outline and 0.25 on it, faces cut in two triangles through the inner corner (Moloney
/// 2008, A.4); `splatting` the chords of a sphere as wide as the brick. Bricks that reach behind the eye are done by
/// each ray's way through them.
///
/// Throws Error(bad_input) for a resolution out of range. Uses the calling thread's arena.
CostMap cost_map(const scene::Camera& camera, scene::ImageSize image, const scene::GridGeometry& geometry,
                 const VisibleCells& cells, std::span<const CostBox> bricks, const CostSettings& settings);

}  // namespace tessera::volume
