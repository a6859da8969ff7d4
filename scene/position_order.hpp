// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::scene {

/// Orders positions by x, then y, then z. Cells that share a face are split the same way, and meshes are watertight,
/// only because all code that orders corners uses this order.
inline bool is_before(const glm::dvec3& a, const glm::dvec3& b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace tessera::scene
