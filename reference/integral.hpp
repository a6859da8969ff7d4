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
  Integral(std::span<const scene::Knot> knots, scene::Emission emission, const std::optional<Peel>& peel = std::nullopt)
      : knots_(knots), emission_(emission) {
    if (peel) cuts_.emplace(*peel);
  }

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

  [[nodiscard]] std::array<double, 3> color() const { return sum_.color; }  ///< linear RGB, premultiplied
  [[nodiscard]] double opacity() const;                                     ///< A = 1 - T, without cancellation
  [[nodiscard]] double optical_depth() const { return sum_.optical_depth; }

  /// Planar depth where the optical depth starts to grow; infinite if it does nowhere.
  [[nodiscard]] double first_visible_depth() const { return sum_.first_visible_depth; }

  /// With a Peel, of which all else tells the layer at hand alone.
  [[nodiscard]] std::vector<Pixel> layers() const { return cuts_->pixels(sum_); }

 private:
  struct Optics {
    double extinction;
    std::array<double, 3> color;
  };
  /// The transfer function at `s`, by the straight line between the two knots that have `within` between them.
  [[nodiscard]] Optics optics(double s, double within, double origin) const;
  /// A stretch on which extinction and colour go linearly from `a` to `b`, cut where layers end.
  void add_piece(double length, Optics a, const Optics& b, double depth_front, double depth_back);
  void add_linear(double length, const Optics& a, const Optics& b);

  std::span<const scene::Knot> knots_;
  scene::Emission emission_;
  LayerSum sum_;
  std::optional<LayerCuts> cuts_;
};

}  // namespace tessera::reference
