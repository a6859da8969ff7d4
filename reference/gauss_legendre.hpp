// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

namespace tessera::reference {

/// Gauss-Legendre quadrature on [-1, 1] with eight points: each entry represents the nodes +x and -x with weight w.
/// Exact for polynomials up to degree 15. Source: Abramowitz, Stegun, table 25.4.
struct GaussNode {
  double x, weight;
};
inline constexpr std::array<GaussNode, 4> gauss_nodes{{{0.1834346424956498, 0.3626837833783620},
                                                       {0.5255324099163290, 0.3137066458778873},
                                                       {0.7966664774136267, 0.2223810344533745},
                                                       {0.9602898564975363, 0.1012285362903763}}};

}  // namespace tessera::reference
