// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "integrals/lane_table.hpp"
#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/selection.hpp"
#include "volume/bricks/brick_cache.hpp"
#include "volume/bricks/cell_ranges.hpp"
#include "volume/lane_error_bound.hpp"
#include "volume/lanes/preintegrated_table.hpp"
#include "volume/precise/surface_view.hpp"
#include "volume/render.hpp"
#include "volume/split/learned_work.hpp"

namespace tessera::volume {

/// A half-space to which rays are clipped, in index space: constant + dot(slope, position) >= 0. The largest component
/// of the slope is 1 in magnitude, so that values are in voxels.
struct KeptSide {
  double constant;
  glm::dvec3 slope;
};

/// Rays of all pixels in index space (voxels, scene/grid.hpp), affine in pixel coordinates.
///
/// The ray of pixel (x, y), y downwards, is origin(x, y) + t * direction(x, y), where t is planar depth in world units.
struct PixelRays {
  glm::dvec3 origin, origin_x, origin_y;  ///< origin(x, y) = origin + x * origin_x + y * origin_y
  glm::dvec3 direction, direction_x, direction_y;
  double tangent_x0, tangent_y0, tangent_step;  ///< perspective: tangent = (x - x0, y - y0) * step; 0 orthographic
  double near_depth, far_depth;
  std::vector<KeptSide> kept;

  /// Camera and size must be valid, and the grid regular.
  PixelRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
            std::span<const scene::HalfSpace> clip = {});
};

/// Light and material for the kernels. Gradients are per voxel along the grid's axes. With W the linear part of the map
/// from world to index space times `unit`, the world gradient of a gradient g is W^T g.
struct ShadingView {
  float ambient, diffuse, specular, shininess;
  float metric[3][3];  ///< W W^T, for squared lengths of world gradients
  float light[3];      ///< W l, where l is the unit vector towards the light, for dot products with it
  /// Upper bound of the derivative of light by a gradient's components, times the gradient's length.
  float light_per_noise;
  double unit;  ///< length unit of world gradients, in world units: the side of a voxel, so that squares are in the
                ///< range of a float
  double light_eye[3];  ///< l along the camera's right and up axes and towards the eye
};

/// The data shared by all tiles of one frame; read-only while they are rendered.
struct FrameView {
  const PixelRays* rays;
  const integrals::LaneTable* table;
  const CellRanges* ranges;
  LaneSamples lanes;                  ///< `ranges->lanes`, but not rounded to integers where fractions are needed
  bool has_rest = false;              ///< whether gradients are needed and lanes round the samples
  float rest_noise = 0;               ///< if `has_rest`: rounding error of a gradient's components, in lane units
  const std::uint8_t* visible;        ///< one byte per cell of `ranges`: whether it is visible
  bool some_hidden;                   ///< whether any cell is not visible
  bool some_clear;                    ///< whether the transfer function is invisible at some value in the volume
  const std::uint8_t* brick_visible;  ///< one byte per brick: whether it has voxels of a visible cell
  BrickCache* bricks;
  scene::GridIndex voxels, samples;
  bool cell_data;
  double length_unit;         ///< length unit of the table, in world units
  float least_transmittance;  ///< a ray with less transmittance ends
  float piece_tolerance;      ///< largest error of one piece of a ray, linear RGBA
  float largest_color;
  const LaneErrorBound* error_bound = nullptr;  ///< null: errors are negligible
  float error_tolerance = 0;                    ///< a ray with a larger error bound is cast again
  double step = 0;  ///< sampled, preintegrated: length of a step in the table's unit; otherwise 0
  const PreintegratedTable* preintegrated = nullptr;  ///< null: the integrator is not preintegrated
  const ShadingView* shading = nullptr;               ///< null: no shading
  const SurfaceView* surfaces = nullptr;              ///< null: no surfaces
  WorkTally* tally = nullptr;  ///< not null: this is a pilot pass, which counts the work by position
  int pilot_packets = 0;       ///< number of packets that a pilot pass casts in each tile
  scene::Trace* trace;
};

/// Sums over tiles.
struct TileCounts {
  std::uint64_t rays = 0, voxels_visited = 0, samples = 0;
  std::uint64_t again = 0;  ///< rays cast again in double precision

  TileCounts& operator+=(const TileCounts& other) {
    rays += other.rays, voxels_visited += other.voxels_visited, samples += other.samples, again += other.again;
    return *this;
  }
};

}  // namespace tessera::volume
