// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// A vertex on its line through the eye, in homogeneous pixel coordinates: (x, y, 1) in front of the eye, (-x, -y, -1)
/// behind it, where (x, y) is its pixel position; (X, Y, 0) beside the eye, in the plane through it that faces the
/// view.
struct LineOfSight {
  double x, y, w;
};

/// Where the tie rule sees a vertex. Positions are rounded: what is meant to lie on a pixel's centre, or in the plane
/// of the eye and a row or column of centres, does, in spite of the noise of decimals, of the camera's axes and of the
/// projection. The rule then decides in one way along a whole edge, side or plane of a mesh.
///   - Orthographic (pixels_per_tangent 0): multiples of 2^-32 pixel, as PixelSpace has rounded them.
///   - Perspective: multiples of 2^-32 pixel, or of the power of two in (2^-47, 2^-46] of the largest of |x|, |y| and
///     the pixels per tangent (or 2^22, if those are more), if that is more. It is from 2^15 on: outside of the
///     picture, towards the eye plane, and through long lenses, where the noise is more as well.
///   - A vertex 2^46 or more pixels away lies beside the eye. Of X and Y both are rounded to multiples of the power of
///     two in (2^-41, 2^-40] of the larger.
/// Only a vertex and the view enter, so that all cells see it in one place. Only which side of an edge a ray passes
/// hangs on it: perspective depths and scalars are those at the position that is not rounded, at most 2^-33 pixel from
/// it.
LineOfSight line_of_sight(const PixelVertex& v, double pixels_per_tangent);

/// On which side of the edge a -> b does the ray through pixel position (px, py) pass? Exactly.
///
/// The sign, -1, 0 or +1, of the determinant E = | (px, py, 1) ; a ; b | of the vertices' lines of sight, in exact
/// arithmetic (floating-point expansions: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", 1997). On the edge itself the ray is shifted by (e, e^2) with e infinitely small and
/// positive: the sign is then that of dE/dx, or, where that is zero too, of dE/dy. 0
/// is left only where a and b lie on one line through the eye: such an edge has no sides, and no face with it is hit.
/// edge_sign(a, b) = -edge_sign(b, a).
/// `on_edge`, if any, is set where E is zero: the ray meets the edge.
int edge_sign(const PixelVertex& a, const PixelVertex& b, double px, double py, double pixels_per_tangent,
              bool* on_edge = nullptr);

/// How far line_of_sight() may move a vertex, of which both px and py are below `most_pixels`: a bound of the change of
/// X - px w and Y - py w, w being what it was.
double sight_error(const PixelVertex& v, double pixels_per_tangent, double most_pixels);

}  // namespace tessera::projection
