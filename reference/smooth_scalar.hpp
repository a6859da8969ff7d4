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

  /// A constant scalar.
  SmoothScalar(double front_depth, double back_depth, double value);
  /// From the values at nodes(), front to back. Coefficients below `rounding` are treated as zero.
  SmoothScalar(double front_depth, double back_depth, const std::array<double, terms>& values, double rounding);

  /// Where values are needed: Chebyshev points of the first kind, in [-1, 1].
  static std::array<double, terms> nodes();

  [[nodiscard]] double at(double u) const;

  /// Upper limit of the last terms: about the error of a series truncated there.
  [[nodiscard]] double tail() const;

  /// Turning points of the scalar in (-1, 1), to 1e-7, in order.
  [[nodiscard]] std::vector<double> turning_points() const;

 private:
  [[nodiscard]] double slope(double u) const;

  std::array<double, terms> coefficients_{};
  std::size_t used_ = 1;
};

/// A scalar over depths as pieces, front to back, each accurate to about 1e-14 of `scale` (the magnitude of its
/// changes): halved until the series' last terms are that small. In short pieces, at a singularity or at the level of
/// rounding, they may be larger: the product of error and length is bounded. For a scalar that is not smooth, halving
/// ends after a hundred pieces.
std::vector<SmoothScalar> smooth_pieces(double front, double back, double scale,
                                        const std::function<double(double depth)>& scalar);

}  // namespace tessera::reference
