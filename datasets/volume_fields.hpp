// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>

namespace tessera::datasets {

// Fields on [-1, 1]^3, values in [0, 1], that stand in for the volumes of Moloney, "Ray Coherence in Parallel Volume
// Rendering" (SFU 2008), A.2, which are not to be had. What a brick shows depends on its size over the volume's, so
// shares of bricks hold for any number of samples: bricks of n / 16 are the print's of 32^3 in 510 x 510 x 400.

/// "Values decrease radially from the center" is all that A.2 says: 1 in the middle, 0 at the corners, linear between.
double radial_field(const glm::dvec3& p);

/// For the mummy's head: a skull with its soft tissue, in a case, air between. Where the function shows values above
/// 0.25 alone, the share of the volume in bricks that show is (bricks of n / 32, n / 16, n / 8, n / 4, n / 2):
///
///     printed, Table 6.2   40.6  55.6  79.3  98.1  99.4 %    (millions of samples rendered, of 104.04)
///     here                 40.3  56.4  81.4  100   100 %
///
/// At n / 16 the print has 2438 bricks of 4536, 54 %: 79.89 M samples stored are so many of 32^3.
double head_field(const glm::dvec3& p);

/// For the Richtmyer-Meshkov instability: two fluids of values about 0.1 and 0.9 and what mixes between them, rough at
/// all scales: no two bricks are alike, and none is empty if all values show. Where 0.3 to 0.7 show alone, 36 % of
/// bricks of n / 16 do; printed, 6.7.1: 1662 bricks of 64^3 in 1024 x 1024 x 960, of about 4,600.
double turbulence_field(const glm::dvec3& p);

}  // namespace tessera::datasets
