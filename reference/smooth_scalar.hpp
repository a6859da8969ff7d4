// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tessera::reference {

/// A scalar along a piece of a ray: a polynomial of degree twelve at most, as a Chebyshev series over u in [-1, 1]
/// (front to back). Coefficients below rounding are omitted, so that a linear scalar has degree one.
class SmoothScalar {
 public:
  static constexpr std::size_t terms = 13;

  double front = 0, back = 0;  ///< planar depths

  /// Creates a constant scalar.
  SmoothScalar(double front_depth, double back_depth, double value);
  /// Creates a scalar from its values at nodes(), front to back. Coefficients below `rounding` are treated as zero.
  SmoothScalar(double front_depth, double back_depth, const std::array<double, terms>& values, double rounding);

  /// Returns the positions where values are needed: Chebyshev points of the first kind, in [-1, 1].
  static std::array<double, terms> nodes();

  [[nodiscard]] double at(double u) const;

  /// Returns an upper limit of the last terms, which is about the error of a series truncated there.
  [[nodiscard]] double tail() const;

  /// Returns the turning points of the scalar in (-1, 1), to 1e-7, in order.
  [[nodiscard]] std::vector<double> turning_points() const;

 private:
  [[nodiscard]] double slope(double u) const;

  std::array<double, terms> coefficients_{};
  std::size_t used_ = 1;
};

/// Returns a scalar over depths as pieces, front to back. Each is accurate to about 1e-14 of `scale` (the magnitude of
/// the scalar's changes): pieces are halved until the last terms of their series are that small. In short pieces, at a
/// singularity or at the level of rounding, the terms may be larger: the product of error and length is bounded. For a
/// scalar that is not smooth, halving ends after a hundred pieces.
std::vector<SmoothScalar> smooth_pieces(double front, double back, double scale,
                                        const std::function<double(double depth)>& scalar);

}  // namespace tessera::reference
