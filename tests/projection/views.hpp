// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/camera.hpp"

namespace tessera::projection {

/// Views of meshes that fill [-1, 1]^3, for the tests of rasterizers.

inline scene::Camera oblique() {
  scene::Camera camera;
  camera.position = {3.1, 2.3, 4.2};
  camera.parallel_scale = 1.8;
  return camera;
}

inline scene::Camera perspective(const glm::dvec3& position, double angle) {
  scene::Camera camera;
  camera.position = position;
  camera.focal_point = {0.05, -0.1, 0.02};
  camera.projection = scene::ProjectionKind::perspective;
  camera.view_angle = angle;
  return camera;
}

/// A view along z in which a vertex of the split of [-1, 1]^3 into n voxels is on every second pixel's centre.
inline scene::Camera aligned(int n, int height) {
  scene::Camera camera;
  const double pixel = 1.0 / n;  // half a voxel
  camera.position = {pixel / 2, -pixel / 2, 5};
  camera.focal_point = {pixel / 2, -pixel / 2, 0};
  camera.parallel_scale = pixel * height / 2;
  return camera;
}

}  // namespace tessera::projection
