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

/// Opacity per unit distance in [0, 1], and how it goes on to the next point: `midpoint` (0..1) is where on the way the
/// mean of the two is reached, `sharpness` 0 is linear, 1 a step at the midpoint, between them an S.
struct OpacityPoint {
  double value, opacity, midpoint = 0.5, sharpness = 0;
};

/// Opacity at `t` in [0, 1] of the way from `a` to `b`, as VTK's vtkPiecewiseFunction defines it. At a step (sharpness
/// above 0.99) the value at the midpoint is the second point's.
double mix_opacities(const OpacityPoint& a, const OpacityPoint& b, double t);

/// A transfer function as visualization programs keep it: colours and opacities apart, each with its own points.
/// Holds: neither is empty; values finite and not decreasing; two points of one value are a step.
struct TransferCurves {
  std::vector<ColorPoint> colors;
  std::vector<OpacityPoint> opacities;
  ColorSpace space = ColorSpace::rgb;
  bool hue_wraps = false;
};

/// How curves become knots.
struct RefineSettings {
  double unit_distance = 1;       ///< world units over which an opacity holds
  double opacity_scale = 1;       ///< multiplies extinction
  bool display_colors = false;    ///< keep display colours instead of decoding them
  double color_tolerance = 1e-4;  ///< largest error of a colour component between knots
  /// Largest error of extinction between knots, in proportion to it, but below an extinction of 0.01 / unit distance
  /// in proportion to that: a ray of any length then errs by less than 4e-5 in alpha while its opacity per unit
  /// distance is 0.01 or more.
  double extinction_tolerance = 1e-4;
};

/// Opacities this near 1 and nearer are taken as this: extinction would be infinite (ANARI allows the same). A ray of
/// one unit distance lets 1e-6 through.
inline constexpr double largest_opacity = 1 - 1e-6;

/// The curves as knots of linear colour and extinction, kappa = -ln(1 - a) / d of the interpolated opacity. All points
/// and steps are kept; knots between them are added only where a straight line would miss by more than the tolerance,
/// each as far from the last as that allows. Throws Error(bad_input) beyond 200,000 knots.
std::vector<scene::Knot> refined_knots(const TransferCurves& curves, const RefineSettings& settings);

}  // namespace tessera::colormaps
