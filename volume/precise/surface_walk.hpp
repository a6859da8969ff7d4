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

/// The planar depth where a ray crosses a surface, and the light that the surface sends to the eye.
struct SurfaceCrossing {
  double z;
  scene::SurfaceSet::Light light;
};

/// Finds the crossings of rays and iso-surfaces of a grid with point data, in double precision, for regular and
/// rectilinear grids. For one thread.
///
/// Places    Crossings are the roots of the cubic that the trilinear field is along a ray in a voxel: all roots where
///           the field changes between below the value and at or above the value, in order along the ray. Voxels that
///           share a face compute the same bits there, and the sign of the field relative to a value follows from the
///           voxel's samples: weights are exact at lattice planes, and sums of products keep their sign. Therefore no
///           crossing is lost or found twice between voxels, and none is found where all samples are on one side.
/// Cut       Where a ray begins or ends in a clip plane, a field within 1e-10 of a surface's value counts as equal to
///           the value, as tessera/selection.hpp specifies for meshes.
/// Normal    The normal is the trilinear field's gradient; where it is zero, the surface is assumed to face the eye.
/// Blank     Voxels with a blank corner have no surface, nor do their faces.
/// Skips     Cells of 8^3 voxels that contain none of the values (GridSurfaces::holding) are skipped.
class SurfaceWalk {
 public:
  /// `source` and `surfaces` must outlive this object.
  SurfaceWalk(const scene::SampleSource& source, const GridSurfaces& surfaces);

  /// Appends the crossings of a ray. Stops where the transmittance of the surfaces alone is below `least`; returns
  /// whether it stopped.
  bool find(const VoxelRay& ray, double least, std::vector<SurfaceCrossing>& found);

 private:
  struct Stretch;

  /// Finds the crossings in the ray's current voxel. Returns the remaining part of `through`.
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
