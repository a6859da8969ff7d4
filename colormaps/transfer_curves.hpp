// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "colormaps/color_spaces.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::colormaps {

/// Display (sRGB) colour in [0, 1] at a scalar value.
struct ColorPoint {
  double value;
  glm::dvec3 color;
};

/// Opacity per unit distance in [0, 1], and its course to the next point. `midpoint` (0..1) is the position where the
/// mean of both opacities is reached. `sharpness` 0 is linear, 1 is a step at the midpoint, and numbers between are
/// S-curves.
struct OpacityPoint {
  double value, opacity, midpoint = 0.5, sharpness = 0;
};

/// Returns the opacity at the fraction `t` in [0, 1] from `a` to `b`, as VTK's vtkPiecewiseFunction defines it. At a
/// step (sharpness above 0.99) the opacity at the midpoint is that of the second point.
double mix_opacities(const OpacityPoint& a, const OpacityPoint& b, double t);

/// A transfer function in the form used by visualization programs: separate curves of colour and opacity, each with its
/// own points. Invariants: neither curve is empty; values are finite and do not decrease; two points of one value form
/// a step.
struct TransferCurves {
  std::vector<ColorPoint> colors;
  std::vector<OpacityPoint> opacities;
  ColorSpace space = ColorSpace::rgb;
  bool hue_wraps = false;
};

/// How curves are converted to knots.
struct RefineSettings {
  double unit_distance = 1;       ///< length in world units for which opacities are given
  double opacity_scale = 1;       ///< multiplies extinction
  bool display_colors = false;    ///< display colours are not decoded
  double color_tolerance = 1e-4;  ///< largest error of a colour component between knots
  /// Largest relative error of extinction between knots; for extinctions below 0.01 / unit distance, the error is
  /// relative to that number. The error in alpha of a ray of any length is then below 4e-5 if the ray's opacity per
  /// unit distance is 0.01 or more.
  double extinction_tolerance = 1e-4;
};

/// Larger opacities are clamped to this number, because an opacity of 1 would be an infinite extinction (ANARI allows
/// clamping, too). A ray of one unit distance then transmits 1e-6.
inline constexpr double largest_opacity = 1 - 1e-6;

/// Converts curves to knots of linear colour and extinction, kappa = -ln(1 - a) / d for the interpolated opacity a. All
/// points and steps are kept. Knots between them are added only where linear interpolation would exceed the tolerance;
/// each is as far from the previous knot as the tolerance allows. Throws Error(bad_input) if there are more than
/// 200,000 knots.
std::vector<scene::Knot> refined_knots(const TransferCurves& curves, const RefineSettings& settings);

}  // namespace tessera::colormaps
