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

/// A polynomial of degree three in u: c[0] + c[1] u + c[2] u^2 + c[3] u^3.
struct Cubic {
  std::array<double, 4> c{0, 0, 0, 0};

  [[nodiscard]] double at(double u) const { return ((c[3] * u + c[2]) * u + c[1]) * u + c[0]; }
};

/// The volume rendering integral along one ray, front to back, for a scalar that is a cubic in each segment. The class
/// Integral does the same for linear scalars.
///
/// A segment is cut at the turning points of the cubic, and where the cubic passes a knot of the transfer function
/// (bisection down to neighbouring doubles). In a piece, extinction and colour are cubics, too. The optical depth is a
/// quartic in closed form, and the colour is computed by Gauss-Legendre quadrature with eight points on steps of at
/// most half a unit of optical depth. The error is about 1e-12 in linear RGBA. Integration stops where T < 1e-18.
class GridIntegral {
 public:
  /// The knots must outlive the integral.
  GridIntegral(std::span<const scene::Knot> knots, scene::Emission emission,
               const std::optional<Peel>& peel = std::nullopt)
      : knots_(knots), emission_(emission) {
    if (peel) cuts_.emplace(*peel);
  }

  /// The effect of shading on a segment: colour c becomes own * c + white.
  struct Light {
    double own = 1, white = 0;
  };

  /// Adds the next segment: its world length, the scalar over u in [0, 1], the planar depths at its ends, and its
  /// light. Scalars are relative to `origin`, so that they may be closer to a knot than doubles of their magnitude can
  /// represent.
  void add(double length, const Cubic& scalar, double depth_front, double depth_back, const Light& light,
           double origin = 0);
  void add(double length, const Cubic& scalar, double depth_front, double depth_back) {
    add(length, scalar, depth_front, depth_back, Light());
  }

  /// Adds an infinitely thin surface with its own lit colour, opacity and depth.
  void add_surface(const std::array<double, 3>& color, double opacity, double depth);

  [[nodiscard]] std::array<double, 3> color() const { return sum_.color; }  ///< linear RGB, premultiplied
  [[nodiscard]] double opacity() const;
  [[nodiscard]] double optical_depth() const { return sum_.optical_depth; }
  [[nodiscard]] double first_visible_depth() const { return sum_.first_visible_depth; }
  [[nodiscard]] bool opaque() const;  ///< nothing behind the current depth is visible

  /// Returns the layers of a Peel, if one was passed. All other results then refer only to the current layer.
  [[nodiscard]] std::vector<Pixel> layers() const { return cuts_->pixels(sum_); }

 private:
  /// Adds the piece u0 to u1 of a segment, in which the transfer function is linear.
  void add_piece(double length, const Cubic& scalar, double u0, double u1, double depth_front, double depth_back,
                 const Light& light, double origin);
  /// Adds the colour of [u0, u1], which is at optical depth `before` behind the front of the piece.
  void add_color(double length, double u0, double u1, double before, const Cubic& extinction,
                 const std::array<Cubic, 3>& color, int depth);

  std::span<const scene::Knot> knots_;
  scene::Emission emission_;
  LayerSum sum_;
  std::optional<LayerCuts> cuts_;
};

}  // namespace tessera::reference
