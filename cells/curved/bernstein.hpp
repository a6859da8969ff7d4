// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace tessera::cells {

/// Polynomials of one degree on a simplex (a segment, triangle or tetrahedron), from their values on its lattice to
/// Bernstein's form, whose coefficients bound them: a polynomial lies between its least and greatest coefficient.
///
/// Source  Farin, "Triangular Bernstein-Bezier patches", Computer Aided Geometric Design 3, 1986.
struct BernsteinForm {
  /// Of each lattice point but the corners, `corners` numbers that add up to `degree`: its place in barycentric
  /// coordinates, times the degree.
  std::vector<std::array<int, 4>> points;
  /// coefficient[k] = sum of matrix[j * points.size() + k] * value[j], for polynomials that are 0 in the corners.
  std::vector<double> matrix;
};

/// For `corners` 2 to 4 and a degree of 1 to `highest_degree`. Made once, kept as long as the program runs; from any
/// thread.
const BernsteinForm& bernstein_form(int corners, int degree);

/// Bernstein's polynomials on the lattice: row p has all of them at its point p. Of a point, lattice places of the
/// second corner run fastest, then the third's, the fourth's. As above in all else.
const std::vector<double>& bernstein_values(int corners, int degree);

/// A tetrahedron's coefficients, those of its corners among them, and what they become when it is halved.
class BernsteinNet {
 public:
  explicit BernsteinNet(int degree);

  [[nodiscard]] std::size_t size() const { return points_.size(); }
  /// Barycentric coordinates, times the degree.
  [[nodiscard]] std::span<const std::array<int, 4>> points() const { return points_; }
  [[nodiscard]] std::size_t index(const std::array<int, 4>& point) const { return index_[place(point)]; }
  [[nodiscard]] std::size_t corner(std::size_t c) const { return corner_[c]; }

  /// The coefficients of the halves at corners i and j, whose other corner j or i is the edge's middle then
  /// (de Casteljau's algorithm).
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

/// Made once, kept as long as the program runs; from any thread.
const BernsteinNet& bernstein_net(int degree);

inline constexpr int highest_degree = 12;  ///< whose coefficients still follow from values to 1e-10 or so

}  // namespace tessera::cells
