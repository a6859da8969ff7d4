// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::colormaps {

/// IEC 61966-2-1: display value to linear light and back. Odd functions, so that numbers below 0 and above 1 survive.
double decode_srgb(double display);
double encode_srgb(double linear);
glm::dvec3 decode_srgb(const glm::dvec3& display);
glm::dvec3 encode_srgb(const glm::dvec3& linear);

/// Where two colours are mixed.
enum class ColorSpace {
  rgb,        ///< the display values themselves
  hsv,        ///< hue, saturation, value
  lab,        ///< CIE L*a*b*, white D65
  diverging,  ///< Msh, through white between two saturated colours of different hue: Moreland, "Diverging Color Maps
              ///< for Scientific Visualization", ISVC 2009
  step,       ///< constant: the second colour
};

/// Display (sRGB) colour at `t` in [0, 1] of the way from `a` to `b`, which are display colours in [0, 1]. The ends are
/// exactly `a` and `b` (step: `b` at both). Colours outside the display's gamut on the way are brought in as VTK does
/// it: scaled down by the largest component if that is above 1, negative components set to 0.
/// `hue_wraps` (hsv): hue takes the shorter way round, through 0 if need be; otherwise it never goes through 0.
/// Smooth in t but for gamut edges, hue's sextants and, for diverging, t = 1/2.
glm::dvec3 mix_colors(const glm::dvec3& a, const glm::dvec3& b, double t, ColorSpace space, bool hue_wraps = false);

}  // namespace tessera::colormaps
