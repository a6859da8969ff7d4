// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::scene {

/// Orders positions by x, then y, then z. All code that orders corners must use this order: only then are cells that
/// share a face split in the same way, so that meshes are watertight.
inline bool is_before(const glm::dvec3& a, const glm::dvec3& b) {
  if (a.x != b.x) return a.x < b.x;
  return a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace tessera::scene
