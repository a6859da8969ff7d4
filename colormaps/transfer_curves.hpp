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

/// Opacity per unit distance in [0, 1], and its course to the next point: `midpoint` (0..1) is where the mean of the
/// two is reached, `sharpness` 0 is linear, 1 a step at the midpoint, an S-curve between.
struct OpacityPoint {
  double value, opacity, midpoint = 0.5, sharpness = 0;
};

/// Opacity at the fraction `t` in [0, 1] from `a` to `b`, as defined by VTK's vtkPiecewiseFunction. At a step
/// (sharpness above 0.99) the value at the midpoint is the second point's.
double mix_opacities(const OpacityPoint& a, const OpacityPoint& b, double t);

/// A transfer function in the form used by visualization programs: separate colours and opacities, each with its own
/// points. Invariants: neither is empty; values are finite and do not decrease; two points of one value form a step.
struct TransferCurves {
  std::vector<ColorPoint> colors;
  std::vector<OpacityPoint> opacities;
  ColorSpace space = ColorSpace::rgb;
  bool hue_wraps = false;
};

/// How curves are converted to knots.
struct RefineSettings {
  double unit_distance = 1;       ///< world units for which an opacity is given
  double opacity_scale = 1;       ///< multiplies extinction
  bool display_colors = false;    ///< keep display colours instead of decoding them
  double color_tolerance = 1e-4;  ///< largest error of a colour component between knots
  /// Largest relative error of extinction between knots; below an extinction of 0.01 / unit distance, relative to that
  /// value. The error in alpha of a ray of any length is then below 4e-5 if its opacity per unit distance is 0.01 or
  /// more.
  double extinction_tolerance = 1e-4;
};

/// Larger opacities are clamped to this: extinction would be infinite (ANARI allows the same). A ray of one unit
/// distance transmits 1e-6.
inline constexpr double largest_opacity = 1 - 1e-6;

/// The curves as knots of linear colour and extinction, kappa = -ln(1 - a) / d of the interpolated opacity. All points
/// and steps are kept; knots between them are added only where linear interpolation would exceed the tolerance, each as
/// far from the last as that allows. Throws Error(bad_input) beyond 200,000 knots.
std::vector<scene::Knot> refined_knots(const TransferCurves& curves, const RefineSettings& settings);

}  // namespace tessera::colormaps
