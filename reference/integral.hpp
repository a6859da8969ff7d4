#pragma once

#include <array>
#include <limits>
#include <span>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// The volume rendering integral along one ray, grown front to back.
///
///   I = int kappa c T dt (absorption) or int c T dt (independent),  T = exp(-int kappa)
///
/// (Max, "Optical Models for Direct Volume Rendering", TVCG 1995.) Along a segment the scalar is linear, so between two
/// knots of the transfer function kappa and c are linear and the optical depth is a parabola, known in closed form. The
/// integral of each such piece is Gauss-Legendre quadrature with eight points on steps of at most half a unit of
/// optical depth, where it is exact to rounding. It stops where T < 1e-18.
class Integral {
 public:
  /// The knots must outlive the integral.
  Integral(std::span<const scene::Knot> knots, scene::Emission emission) : knots_(knots), emission_(emission) {}

  /// What shading makes of colour c over a segment: own * c + white.
  struct Light {
    double own = 1, white = 0;
  };

  /// The next segment: its world length and the scalars at its ends, and the planar depths there. A scalar constant
  /// along the segment and exactly on a step of the transfer function takes the step's upper knot. Scalars are counted
  /// from `origin`, so that they may be nearer to a knot than numbers of their size tell apart.
  void add(double length, double scalar_front, double scalar_back, double depth_front, double depth_back, double origin,
           const Light& light);
  void add(double length, double scalar_front, double scalar_back, double depth_front, double depth_back,
           double origin = 0) {
    add(length, scalar_front, scalar_back, depth_front, depth_back, origin, Light());
  }

  /// A surface of no thickness: its own colour, as lit, its opacity and where it is.
  void add_surface(const std::array<double, 3>& color, double opacity, double depth);

  [[nodiscard]] std::array<double, 3> color() const { return color_; }  ///< linear RGB, premultiplied
  [[nodiscard]] double opacity() const;                                 ///< A = 1 - T, without cancellation
  [[nodiscard]] double optical_depth() const { return optical_depth_; }

  /// Planar depth where the optical depth starts to grow; infinite if it does nowhere.
  [[nodiscard]] double first_visible_depth() const { return first_visible_depth_; }

 private:
  struct Optics {
    double extinction;
    std::array<double, 3> color;
  };
  /// The transfer function at `s`, by the straight line between the two knots that have `within` between them.
  [[nodiscard]] Optics optics(double s, double within, double origin) const;
  /// A stretch on which extinction and colour go linearly from `a` to `b`.
  void add_linear(double length, const Optics& a, const Optics& b);

  std::span<const scene::Knot> knots_;
  scene::Emission emission_;
  std::array<double, 3> color_{0, 0, 0};
  double optical_depth_ = 0;
  double first_visible_depth_ = std::numeric_limits<double>::infinity();
};

}  // namespace tessera::reference
