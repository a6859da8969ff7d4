// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "reference/curved/dense_matrix.hpp"

namespace tessera::reference {

/// The domain of a cell's own coordinates (r, s, t).
enum class Domain : std::uint8_t {
  tet,    ///< r, s, t >= 0, r + s + t <= 1
  prism,  ///< r, s >= 0, r + s <= 1, 0 <= t <= 1
  box     ///< 0 <= r, s, t <= 1; also for a pyramid, whose face t = 1 is its apex
};

/// Whether a place is in the domain, or at most `tolerance` outside.
bool holds(Domain domain, const glm::dvec3& place, double tolerance);

/// One face of a domain: the plane piece origin + u * along_u + v * along_v, over 0 <= u, v <= 1 or, for a triangle,
/// over u, v >= 0, u + v <= 1.
///
/// Control  the functions of the cell's basis that do not vanish there, as (j, i) with i fastest: Bernstein polynomials
///          of degree u_degree in u and v_degree in v; for a triangle of degree u_degree = v_degree in both, with i + j
///          at most that.
struct FacePatch {
  bool triangle = false;
  int u_degree = 1, v_degree = 1;
  glm::dvec3 origin{0}, along_u{0}, along_v{0};
  std::vector<std::size_t> control;
};

/// Bernstein polynomials over a domain: a basis in which the control points of any polynomial map of a cell have a
/// convex hull that contains it, and in which faces have those control points of the cell that are on them.
///
/// Order   k outermost, i innermost; i, j and k are the degrees in r, s and t. For a box up to the degree in each, for
///         a prism i + j up to that of the triangle, for a tet i + j + k up to its own.
/// Source  Farin, "Curves and Surfaces for Computer-Aided Geometric Design", 1997, chapters 4, 15 and 17.
class BernsteinBasis {
 public:
  static constexpr int highest_degree = 15;

  /// Tet: of total degree `degree[0]`. Prism: of total degree `degree[0]` in (r, s), of degree `degree[2]` in t.
  BernsteinBasis(Domain domain, std::array<int, 3> degree);

  [[nodiscard]] Domain domain() const { return domain_; }
  [[nodiscard]] std::array<int, 3> degree() const { return degree_; }
  [[nodiscard]] std::size_t size() const { return exponents_.size(); }

  /// The functions and their gradients at a place, which may be outside the domain. Both spans have length size().
  void evaluate(const glm::dvec3& place, std::span<double> values, std::span<glm::dvec3> gradients) const;

  /// Equally spaced places, one per function.
  [[nodiscard]] std::vector<glm::dvec3> lattice() const;

  /// The matrix from a polynomial's values on the lattice to its coefficients.
  [[nodiscard]] Matrix from_lattice() const;

  [[nodiscard]] std::vector<FacePatch> faces() const;

 private:
  [[nodiscard]] std::size_t index(int i, int j, int k) const;

  Domain domain_;
  std::array<int, 3> degree_;
  std::vector<std::array<int, 3>> exponents_;
};

}  // namespace tessera::reference
