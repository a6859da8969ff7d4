// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

/// Functions for directions in the world, of any length that a double represents.
namespace tessera::scene {

inline bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

inline double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Returns the vector with unit length. The vector is scaled first, so that 1e-200 and 1e200 neither underflow nor
/// overflow. It is divided by its length instead of multiplied by the inverse, so that (0, 0, 49) becomes exactly (0,
/// 0, 1).
inline glm::dvec3 unit(const glm::dvec3& v) {
  const glm::dvec3 scaled = v / largest(v);
  return scaled / glm::length(scaled);
}

inline glm::dvec3 rotated(const glm::dvec3& v, const glm::dvec3& axis, double angle) {
  // Rodrigues' formula.
  return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
         axis * (glm::dot(axis, v) * (1 - std::cos(angle)));
}

}  // namespace tessera::scene
