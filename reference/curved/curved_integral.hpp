// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <span>

#include "reference/smooth_scalar.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// The volume rendering integral along one ray, front to back, for a scalar that is an arbitrary smooth function in
/// each segment. The class Integral does the same for linear scalars, GridIntegral for cubics.
///
/// A piece is cut at the turning points of the scalar, and where the scalar passes a knot of the transfer function
/// (bisection down to neighbouring doubles). Between two cuts, extinction and colour are polynomials of degree twelve
/// at most. Optical depth and colour are computed by Gauss-Legendre quadrature with eight points, on steps of at most
/// half a unit of optical depth. The error is about 1e-12 in linear RGBA if the scalar is exact. Integration stops
/// where T < 1e-18.
class CurvedIntegral {
 public:
  /// The knots must outlive the integral.
  CurvedIntegral(std::span<const scene::Knot> knots, scene::Emission emission) : knots_(knots), emission_(emission) {}

  /// linear RGB, premultiplied
  void add(const SmoothScalar& scalar, double length_per_depth, double origin);

  [[nodiscard]] std::array<double, 3> color() const { return color_; }  ///< linear RGB, premultiplied
  [[nodiscard]] double opacity() const;
  [[nodiscard]] double optical_depth() const { return optical_depth_; }
  [[nodiscard]] double first_visible_depth() const { return first_visible_depth_; }

 private:
  /// The part of the transfer function between two knots, which is linear in the scalar.
  struct Ramp {
    double value = 0;  ///< relative to `origin`; the other members are given at this value
    double extinction = 0, extinction_slope = 0;
    std::array<double, 3> color{}, color_slope{};
  };
  /// Returns the ramp that contains `within`; a value on a step belongs to the step's upper knot.
  [[nodiscard]] Ramp ramp(double within, double origin) const;

  void add_cut(const SmoothScalar& scalar, double u0, double u1, double half_length, double origin);
  /// Adds the light of [u0, u1]. `before` is the optical depth between the beginning of the cut and u0. `half_length`
  /// is the length per unit of u.
  void add_light(const SmoothScalar& scalar, const Ramp& ramp, double u0, double u1, double half_length, double before,
                 int halvings);

  std::span<const scene::Knot> knots_;
  scene::Emission emission_;
  std::array<double, 3> color_{0, 0, 0};
  double optical_depth_ = 0;
  double first_visible_depth_ = std::numeric_limits<double>::infinity();
};

}  // namespace tessera::reference
