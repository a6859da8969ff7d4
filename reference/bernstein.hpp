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

/// Whether a place is in the domain, or outside by at most `tolerance`.
bool holds(Domain domain, const glm::dvec3& place, double tolerance);

/// One face of a domain: the plane piece origin + u * along_u + v * along_v, over 0 <= u, v <= 1 or, for a triangle,
/// over u, v >= 0, u + v <= 1.
///
/// Control  The functions of the cell's basis that do not vanish on the face, as (j, i) with i fastest: Bernstein
///          polynomials of degree u_degree in u and v_degree in v. On a triangle both degrees are equal, and i + j is
///          at most that degree.
struct FacePatch {
  bool triangle = false;
  int u_degree = 1, v_degree = 1;
  glm::dvec3 origin{0}, along_u{0}, along_v{0};
  std::vector<std::size_t> control;
};

/// Bernstein polynomials over a domain. In this basis, the convex hull of the control points of any polynomial map of a
/// cell contains the cell, and the control points of a face are those of the cell's control points that are on the
/// face.
///
/// Order   k outermost, i innermost; i, j and k are the degrees in r, s and t. For a box, each is at most the degree in
///         its direction; for a prism, i + j is at most the degree of the triangle; for a tet, i + j + k is at most its
///         degree.
/// Source  Farin, "Curves and Surfaces for Computer-Aided Geometric Design", 1997, chapters 4, 15 and 17.
class BernsteinBasis {
 public:
  static constexpr int highest_degree = 15;

  /// For a tet, `degree[0]` is the total degree. For a prism, `degree[0]` is the total degree in (r, s), `degree[2]`
  /// the degree in t.
  BernsteinBasis(Domain domain, std::array<int, 3> degree);

  [[nodiscard]] Domain domain() const { return domain_; }
  [[nodiscard]] std::array<int, 3> degree() const { return degree_; }
  [[nodiscard]] std::size_t size() const { return exponents_.size(); }

  /// Evaluates the functions and their gradients at a place, which may be outside the domain. Both spans have length
  /// size().
  void evaluate(const glm::dvec3& place, std::span<double> values, std::span<glm::dvec3> gradients) const;

  /// Equally spaced places, one per function.
  [[nodiscard]] std::vector<glm::dvec3> lattice() const;

  /// Returns the matrix that converts a polynomial's values on the lattice to its coefficients.
  [[nodiscard]] Matrix from_lattice() const;

  [[nodiscard]] std::vector<FacePatch> faces() const;

 private:
  [[nodiscard]] std::size_t index(int i, int j, int k) const;

  Domain domain_;
  std::array<int, 3> degree_;
  std::vector<std::array<int, 3>> exponents_;
};

}  // namespace tessera::reference
