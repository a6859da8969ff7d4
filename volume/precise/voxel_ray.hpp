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

/// A view ray in a grid's local frame: at planar depth z it is at origin + z * step. It is in the volume and in view
/// between `begin` and `end` (empty if begin >= end).
struct VoxelRay {
  glm::dvec3 origin, step;
  double length_per_depth, begin, end;
  glm::dvec3 aside{0};  ///< moves a ray that is in a lattice plane into the voxels to which the ray belongs
  /// Equal to `begin` or `end` if that is in a clip plane; otherwise NaN.
  double begin_cut = nowhere, end_cut = nowhere;

  static constexpr double nowhere = std::numeric_limits<double>::quiet_NaN();
};

/// The rays of an image, for any lattice.
class VoxelRays {
 public:
  /// Camera and size must be valid. Rays are clipped to the half-spaces of `clip`. A ray in a clip plane belongs to the
  /// side on which it would be if it were shifted as in ray().
  VoxelRays(const scene::Camera& camera, scene::ImageSize size, const scene::GridGeometry& geometry,
            std::span<const scene::HalfSpace> clip = {});

  /// Returns the ray through pixel coordinates (x, y); pixel (i, j) has its centre at (i + 0.5, j + 0.5). A ray in a
  /// lattice plane has the values of that plane, and belongs to the voxels in which it would be if it were shifted by
  /// (e, e^2) pixels for an infinitesimal e.
  [[nodiscard]] VoxelRay ray(double x, double y) const;

 private:
  void cut(const glm::dvec3& from, const glm::dvec3& step, VoxelRay& ray) const;

  scene::Camera camera_;
  const scene::GridGeometry& geometry_;
  scene::ViewBasis basis_;
  glm::dmat3 to_local_;
  bool perspective_;
  double width_, height_, pixel_;
  double deepest_ = 0;                  ///< upper bound of the planar depths of the volume's corners
  std::vector<scene::HalfSpace> clip_;  ///< with unit normals
};

}  // namespace tessera::volume
