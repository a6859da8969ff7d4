// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

/// Perceptual difference of two colours.
namespace tessera::analysis {

/// Converts linear sRGB in [0, 1] to CIE L*a*b* (D65, 2 degrees).
glm::dvec3 lab_of_linear(const glm::dvec3& linear);

/// Returns the colour difference CIEDE2000 with all weights 1. A difference of about 1 is just noticeable. Source:
/// Sharma, Wu, Dalal, "The CIEDE2000 Color-Difference Formula: Implementation Notes, Supplementary Test Data, and
/// Mathematical Observations", Color Research and Application 30, 2005.
double delta_e_2000(const glm::dvec3& lab_1, const glm::dvec3& lab_2);

}  // namespace tessera::analysis
