// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

/// Converts polynomials of one degree on a simplex (a segment, triangle or tetrahedron) from their values on the
/// simplex's lattice to Bernstein form. The coefficients bound a polynomial: it is between its least and greatest
/// coefficient.
///
/// Source  Farin, "Triangular Bernstein-Bezier patches", Computer Aided Geometric Design 3, 1986.
struct BernsteinForm {
  /// For each lattice point except the corners: the barycentric coordinates times the degree. These are `corners`
  /// numbers with sum `degree`.
  std::vector<std::array<int, 4>> points;
  /// The matrix from values to coefficients: coefficient[k] = sum of matrix[j * points.size() + k] * value[j], for
  /// polynomials that are 0 at the corners.
  std::vector<double> matrix;
};

/// Returns the form for `corners` from 2 to 4 and a degree from 1 to `highest_degree`. It is computed once and kept
/// until the program ends. Callable from any thread.
const BernsteinForm& bernstein_form(int corners, int degree);

/// Returns the values of the Bernstein polynomials on the lattice: row p contains all of them at point p. The lattice
/// index of the second corner runs fastest, then that of the third, then that of the fourth. Limits and lifetime are
/// those of bernstein_form().
const std::vector<double>& bernstein_values(int corners, int degree);

/// The coefficients of a tetrahedron, including those at its corners, and how they change when the tetrahedron is
/// halved.
class BernsteinNet {
 public:
  explicit BernsteinNet(int degree);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  /// For each coefficient, the barycentric coordinates of its lattice point times the degree.
  [[nodiscard]] std::span<const std::array<int, 4>> points() const { return points_; }
  [[nodiscard]] std::size_t index(const std::array<int, 4>& point) const { return index_[place(point)]; }
  [[nodiscard]] std::size_t corner(std::size_t c) const { return corner_[c]; }

  /// Computes the coefficients of the two halves of a tetrahedron. One half keeps corner i and the other corner j; the
  /// midpoint of the edge between i and j replaces the other corner (de Casteljau's algorithm).
  void halve(std::span<const glm::dvec4> net, int i, int j, std::span<glm::dvec4> half_i,
             std::span<glm::dvec4> half_j) const;

 private:
  [[nodiscard]] std::size_t place(const std::array<int, 4>& point) const {
    const auto at = [](int number) { return static_cast<std::size_t>(number); };
    return (at(point[1]) * side_ + at(point[2])) * side_ + at(point[3]);
  }

  int degree_;
  std::size_t side_;
  std::vector<std::array<int, 4>> points_;
  std::vector<std::size_t> index_;
  std::array<std::size_t, 4> corner_{};
};

/// Returns the net of a degree. It is computed once and kept until the program ends. Callable from any thread.
const BernsteinNet& bernstein_net(int degree);

inline constexpr int highest_degree = 12;  ///< limit at which coefficients can be computed from values to about 1e-10

}  // namespace tessera::cells
