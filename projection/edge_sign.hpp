#pragma once

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// On which side of the edge a -> b does the ray through pixel position (px, py) pass? Exactly.
///
/// The sign, -1, 0 or +1, of the determinant E = | (px, py, 1) ; a ; b | of homogeneous pixel coordinates, in exact
/// arithmetic on the given doubles (floating-point expansions: Shewchuk, "Adaptive Precision Floating-Point Arithmetic
/// and Fast Robust Geometric Predicates", 1997). Of w its sign alone counts, the rest scales E: so rounded positions
/// (pixel_space.hpp) are what is exact, in perspective too, and nothing is multiplied by a depth. On the edge itself
/// the ray is shifted by (e, e^2) with e infinitely small and positive: the sign is then that of dE/dx, or, where that
/// is zero too, of dE/dy (DESIGN section 3, the tie rule). 0 is left only where a and b lie on one ray, or on opposite
/// ones: such an edge has no sides, and no face with it is hit. edge_sign(a, b) = -edge_sign(b, a). `on_edge`, if any,
/// is set where E is zero: the ray meets the edge.
int edge_sign(const PixelVertex& a, const PixelVertex& b, double px, double py, bool* on_edge = nullptr);

}  // namespace tessera::projection
