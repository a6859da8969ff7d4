// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "tessera/selection.hpp"

namespace tessera::scene {

using tessera::HalfSpace;
using tessera::Selection;

/// Returns the normal of the half-space with unit length.
inline glm::dvec3 unit_normal(const HalfSpace& h) {
  const glm::dvec3 size = glm::abs(h.normal);
  return glm::normalize(h.normal / std::max({size.x, size.y, size.z}));
}

}  // namespace tessera::scene
