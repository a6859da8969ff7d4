// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

#include "scene/camera.hpp"
#include "scene/grid.hpp"
#include "scene/selection.hpp"

namespace tessera::volume {

/// A view ray in a grid's local frame: at planar depth z it is at origin + z * step, and in the volume and in view
/// between `begin` and `end` (empty if begin >= end).
struct VoxelRay {
  glm::dvec3 origin, step;
  double length_per_depth, begin, end;
  glm::dvec3 aside{0};  ///< of the origin, of a ray in a plane of the lattice: where the voxel is that it counts for
  double begin_cut = nowhere, end_cut = nowhere;  ///< `begin` or `end`, if a clip's plane is there

  static constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
};

/// The rays of a picture; any lattice.
class VoxelRays {
 public:
  /// A valid camera and size. Rays are kept in the half-spaces of `clip`; one that runs in a plane of them counts to
  /// the side that it would be on if it were shifted likewise.
  VoxelRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
            std::span<const scene::HalfSpace> clip = {});

  /// Through pixel coordinates (x, y), pixel (i, j) having its centre at (i + 0.5, j + 0.5). Where it runs in a plane
  /// of the lattice it has that plane's values, and counts for the voxels that it would be in if it were shifted by
  /// (e, e^2) pixel, e infinitely small.
  [[nodiscard]] VoxelRay ray(double x, double y) const;

 private:
  void cut(const glm::dvec3& from, const glm::dvec3& step, VoxelRay& ray) const;

  scene::Camera camera_;
  const scene::GridGeometry& geometry_;
  scene::ViewBasis basis_;
  glm::dmat3 to_local_;
  bool perspective_;
  double width_, height_, pixel_;
  double deepest_ = 0;                  ///< planar depth of the volume's corners, at most
  std::vector<scene::HalfSpace> clip_;  ///< normals of length 1
};

}  // namespace tessera::volume
