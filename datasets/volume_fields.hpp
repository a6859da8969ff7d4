// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::datasets {

// Fields on [-1, 1]^3 with values in [0, 1]. They replace the volumes of Moloney, "Ray Coherence in Parallel Volume
// Rendering" (SFU 2008), A.2, which are not available. The fraction of visible bricks depends only on the ratio of the
// brick's side to the side n of the volume: bricks of side n / 16 correspond to the thesis's bricks of 32^3 in
// 510 x 510 x 400.

/// A.2 states only that values decrease radially from the center. Here they are 1 in the middle, 0 at the corners, and
/// linear between.
double radial_field(const glm::dvec3& p);

/// Replaces the mummy's head: a skull with its soft tissue in a case, and air between tissue and case. If the function
/// shows only values above 0.25, the visible bricks contain these fractions of the volume (for bricks of side n / 32,
/// n / 16, n / 8, n / 4, n / 2):
///
///     in Table 6.2   40.6  55.6  79.3  98.1  99.4 %    (millions of samples rendered, of 104.04)
///     here           40.3  56.4  81.4  100   100 %
///
/// For bricks of side n / 16, the thesis has 2438 visible bricks of 4536, or 54 %. The first number is its 79.89 M
/// stored samples divided by 32^3.
double head_field(const glm::dvec3& p);

/// Replaces the Richtmyer-Meshkov instability: two fluids with values of about 0.1 and 0.9 and a mixture between them,
/// rough at all scales. All bricks differ, and none is empty if all values are visible. If only values from 0.3 to 0.7
/// are visible, 36 % of the bricks of side n / 16 are visible. The thesis has the same fraction in 6.7.1: 1662 of about
/// 4,600 bricks of 64^3 in 1024 x 1024 x 960.
double turbulence_field(const glm::dvec3& p);

}  // namespace tessera::datasets
