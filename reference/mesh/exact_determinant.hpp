// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::reference {

/// A determinant whose sign is exact. `value` is the rounded value, which is exactly zero if `sign` is zero.
struct Determinant {
  int sign = 0;  ///< -1, 0 or 1
  double value = 0;
};

/// Returns det[a, b, c] of three rows of doubles, without any intermediate rounding: the 24 partial products of its six
/// terms are summed exactly. Takes about a microsecond. Exact unless a product of three components overflows or
/// underflows (scenes of 1e-90 to 1e90).
/// Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", Discrete &
/// Computational Geometry 1997, sections 2.3 and 2.4 (grow-expansion with zero elimination).
Determinant exact_determinant(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);

}  // namespace tessera::reference
