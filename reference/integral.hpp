// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "reference/layers.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::reference {

/// The volume rendering integral along one ray, accumulated front to back.
///
///   I = int kappa c T dt (absorption) or int c T dt (independent),  T = exp(-int kappa)
///
/// (Max, "Optical Models for Direct Volume Rendering", TVCG 1995.) Along a segment the scalar is linear. Between two
/// knots of the transfer function, kappa and c are therefore linear, and the optical depth is a parabola, known in
/// closed form. Each of these pieces is integrated by Gauss-Legendre quadrature with eight points on steps of at most
/// half a unit of optical depth, which is exact to rounding. Integration stops where T < 1e-18.
class Integral {
 public:
  /// The knots must outlive the integral.
  Integral(std::span<const scene::Knot> knots, scene::Emission emission, const std::optional<Peel>& peel = std::nullopt)
      : knots_(knots), emission_(emission) {
    if (peel) cuts_.emplace(*peel);
  }

  /// The effect of shading on a segment: colour c becomes own * c + white.
  struct Light {
    double own = 1, white = 0;
  };

  /// Adds the next segment: its world length, and the scalars and planar depths at its ends. If a scalar is constant
  /// along the segment and exactly on a step of the transfer function, the step's upper knot is used. Scalars are
  /// relative to `origin`, so that they may be closer to a knot than doubles of their magnitude can represent.
  void add(double length, double scalar_front, double scalar_back, double depth_front, double depth_back, double origin,
           const Light& light);
  void add(double length, double scalar_front, double scalar_back, double depth_front, double depth_back,
           double origin = 0) {
    add(length, scalar_front, scalar_back, depth_front, depth_back, origin, Light());
  }

  /// Adds an infinitely thin surface with its own lit colour, opacity and depth.
  void add_surface(const std::array<double, 3>& color, double opacity, double depth);

  [[nodiscard]] std::array<double, 3> color() const { return sum_.color; }  ///< linear RGB, premultiplied
  [[nodiscard]] double opacity() const;                                     ///< A = 1 - T, without cancellation
  [[nodiscard]] double optical_depth() const { return sum_.optical_depth; }

  /// Planar depth where the optical depth begins to increase; infinite if it does not increase.
  [[nodiscard]] double first_visible_depth() const { return sum_.first_visible_depth; }

  /// Returns the layers of a Peel, if one was passed. All other results then refer only to the current layer.
  [[nodiscard]] std::vector<Pixel> layers() const { return cuts_->pixels(sum_); }

 private:
  struct Optics {
    double extinction;
    std::array<double, 3> color;
  };
  /// Returns the transfer function at `s`, interpolated between the two knots around `within`.
  [[nodiscard]] Optics optics(double s, double within, double origin) const;
  /// Adds a piece on which extinction and colour are linear from `a` to `b`. The piece is cut where layers end.
  void add_piece(double length, Optics a, const Optics& b, double depth_front, double depth_back);
  void add_linear(double length, const Optics& a, const Optics& b);

  std::span<const scene::Knot> knots_;
  scene::Emission emission_;
  LayerSum sum_;
  std::optional<LayerCuts> cuts_;
};

}  // namespace tessera::reference
