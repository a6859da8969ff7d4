// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <glm/mat3x3.hpp>
#include <vector>

#include "scene/sample_source.hpp"
#include "scene/surface_set.hpp"
#include "volume/bricks/sample_blocks.hpp"
#include "volume/precise/grid_surfaces.hpp"
#include "volume/precise/voxel_ray.hpp"

namespace tessera::volume {

class VoxelSteps;

/// Where a ray crosses a surface (planar depth), and what that sends to the eye.
struct SurfaceCrossing {
  double z;
  scene::SurfaceSet::Light light;
};

/// Finds where rays cross the iso-surfaces of a grid with point data, in double precision, one thread's way: regular
/// and rectilinear grids.
///
/// Places   all roots of the cubic that the trilinear field is along a ray in a voxel, where it goes from below the
///          value to it or above, or back; they come in the order along the ray. Voxels that share a side have the same
///          bits there, and which side of a value a field is on follows from its samples: weights that are exact at
///          planes of the lattice, and sums of products that keep their sign. So no crossing is lost or met twice
///          between voxels, and none comes where all samples are on one side.
/// Cut      where a ray begins or ends in a clip's plane the field has a surface's value if that is all but a part in
///          1e10, as tessera/selection.hpp has it of meshes.
/// Normal   the trilinear field's gradient there; where it is zero the surface is seen face on.
/// Blank    voxels with a blank corner have no surface, and their sides are none.
/// Skips    cells of 8^3 voxels that hold no value (GridSurfaces::holding).
class SurfaceWalk {
 public:
  /// Both must outlive it.
  SurfaceWalk(const scene::SampleSource& source, const GridSurfaces& surfaces);

  /// Appends the crossings of a ray, and ends where surfaces alone let less than `least` through. True if they do.
  bool find(const VoxelRay& ray, double least, std::vector<SurfaceCrossing>& found);

 private:
  struct Stretch;

  /// In the voxel that the ray is in. Gives what is left of `through`.
  double cross(const VoxelRay& ray, const VoxelSteps& at, double through, double least,
               std::vector<SurfaceCrossing>& found);
  [[nodiscard]] Stretch stretch_of(const VoxelRay& ray, const scene::GridIndex& voxel, double z0, double z1,
                                   const std::array<double, 8>& corner) const;
  [[nodiscard]] double cosine(const VoxelRay& ray, const Stretch& stretch, double u) const;

  const scene::GridGeometry& geometry_;
  const GridSurfaces& surfaces_;
  glm::dmat3 to_world_gradient_;
  scene::GridIndex voxels_, cells_;
  SampleBlocks blocks_;
};

}  // namespace tessera::volume
