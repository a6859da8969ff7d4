// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tessera::reference {

/// A scalar along a piece of a ray: a polynomial of degree twelve at most, as a Chebyshev series over u in [-1, 1]
/// (front to back). Coefficients below rounding are left out, so that a linear scalar has degree one.
class SmoothScalar {
 public:
  static constexpr std::size_t terms = 13;

  double front = 0, back = 0;  ///< planar depths

  /// A constant.
  SmoothScalar(double front_depth, double back_depth, double value);
  /// The values at nodes(), front to back. What is less than `rounding` counts as nothing.
  SmoothScalar(double front_depth, double back_depth, const std::array<double, terms>& values, double rounding);

  /// Where values are asked for: Chebyshev's points of the first kind, in [-1, 1].
  static std::array<double, terms> nodes();

  [[nodiscard]] double at(double u) const;

  /// What the last terms add at most: about the error of a series cut there.
  [[nodiscard]] double tail() const;

  /// Places in (-1, 1) where the scalar turns round, to 1e-7, in order.
  [[nodiscard]] std::vector<double> turning_points() const;

 private:
  [[nodiscard]] double slope(double u) const;

  std::array<double, terms> coefficients_{};
  std::size_t used_ = 1;
};

/// A scalar over depths as pieces, front to back, each to about 1e-14 of `scale` (a size of its changes): halved until
/// the series' last terms are that small. In short pieces, at a singularity or in rounding, they may be larger: the
/// product of error and length stays. A scalar that is not smooth is left to be what it is after a hundred pieces.
std::vector<SmoothScalar> smooth_pieces(double front, double back, double scale,
                                        const std::function<double(double depth)>& scalar);

}  // namespace tessera::reference
