// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::colormaps {

/// IEC 61966-2-1: converts a display value to linear light, and back. Both functions are odd, so that numbers below 0
/// and above 1 are preserved.
double decode_srgb(double display);
double encode_srgb(double linear);
glm::dvec3 decode_srgb(const glm::dvec3& display);
glm::dvec3 encode_srgb(const glm::dvec3& linear);

/// The colour space in which two colours are interpolated.
enum class ColorSpace {
  rgb,        ///< the display values themselves
  hsv,        ///< hue, saturation, value
  lab,        ///< CIE L*a*b*, white D65
  diverging,  ///< Msh, through white between two saturated colours of different hue: Moreland, "Diverging Color Maps
              ///< for Scientific Visualization", ISVC 2009
  step,       ///< constant: the second colour everywhere
};

/// Returns the display (sRGB) colour at the fraction `t` in [0, 1] from `a` to `b`, which are display colours in [0,
/// 1]. The ends are exactly `a` and `b` (for step, `b` at both ends). Intermediate colours outside the display's gamut
/// are mapped into it as in VTK: they are scaled down by the largest component if that is above 1, and negative
/// components are set to 0. With `hue_wraps`, which applies to hsv, hue takes the shorter direction, through 0 if
/// necessary; otherwise it never goes through 0. The result is smooth in t except at gamut edges, at hue's sextants
/// and, for diverging, at t = 1/2.
glm::dvec3 mix_colors(const glm::dvec3& a, const glm::dvec3& b, double t, ColorSpace space, bool hue_wraps = false);

}  // namespace tessera::colormaps
