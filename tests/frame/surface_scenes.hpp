// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "api/random_cases.hpp"
#include "frame/mesh/render.hpp"

/// Common parts of tests of surfaces in a cube [-1, 1]^3.
namespace tessera::frame {

inline Settings exact(const Surfaces& surfaces, bool lattice = true) {
  Settings settings;
  settings.integrator.kind = scene::IntegratorKind::exact;
  settings.surfaces = surfaces;
  settings.use.lattice = lattice;
  return settings;
}

inline scene::Camera view(scene::ProjectionKind kind, const glm::dvec3& from) {
  scene::Camera camera;
  camera.position = from;
  camera.projection = kind;
  camera.parallel_scale = 1.5;
  camera.view_angle = 38;
  return camera;
}

inline scene::TransferFunction clear() {
  return scene::TransferFunction({{0, {0.2, 0.4, 0.6}, 0}, {1, {0.2, 0.4, 0.6}, 0}});
}
inline scene::TransferFunction grey_fog() {
  return scene::TransferFunction({{0, {0.5, 0.5, 0.5}, 0.7}, {1, {0.5, 0.5, 0.5}, 0.7}});
}

/// Two to five knots, uniform over the range, some of them clear.
inline scene::TransferFunction random_function(Random& random, const std::array<double, 2>& range) {
  std::vector<scene::Knot> knots;
  const int n = 2 + random.below(4);
  knots.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    knots.push_back({range[0] + (range[1] - range[0]) * i / (n - 1),
                     {random.uniform(0, 1), random.uniform(0, 1), random.uniform(0, 1)},
                     random.chance(0.3) ? 0 : random.power(-1, 1)});
  if (!(range[0] < range[1])) knots.resize(1);
  return scene::TransferFunction(knots);
}

}  // namespace tessera::frame
