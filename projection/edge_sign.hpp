// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// The line from the eye through a vertex, in homogeneous pixel coordinates: (x, y, 1) if the vertex is in front of the
/// eye, (-x, -y, -1) if it is behind, where (x, y) is its pixel position; (X, Y, 0) if it is in the eye plane, which
/// is the plane through the eye parallel to the image.
struct LineOfSight {
  double x, y, w;
};

/// The position of a vertex for the tie rule. Positions are rounded: a vertex that is meant to be on a pixel centre, or
/// in the plane of the eye and a row or column of centres, is exactly there, in spite of the noise of decimals, of the
/// camera's axes and of the projection. The rule then decides in the same way along a whole edge, side or plane of a
/// mesh.
///   - Orthographic (pixels_per_tangent 0): multiples of 2^-32 pixel, as PixelSpace has rounded them.
///   - Perspective: multiples of 2^-32 pixel, or, if greater, of the power of two in (2^-47, 2^-46] of the largest of
///     |x|, |y| and min(pixels per tangent, 2^22). It is greater from 2^15 on: outside of the image, towards the eye
///     plane, and with long lenses, where the noise is also greater.
///   - A vertex 2^46 or more pixels away is moved to the eye plane. X and Y are both rounded to multiples of the power
///     of two in (2^-41, 2^-40] of the larger.
/// Only the vertex and the view are used, so that all cells have the same position for it. It only affects on which
/// side of an edge a ray passes: perspective depths and scalars are those at the position before rounding, at most
/// 2^-33 pixel away.
LineOfSight line_of_sight(const PixelVertex& v, double pixels_per_tangent);

/// The side of the edge a -> b on which the ray through pixel position (px, py) passes, exactly.
///
/// Returns the sign, -1, 0 or +1, of the determinant E = | (px, py, 1) ; a ; b | of the vertices' lines of sight, in
/// exact arithmetic (floating-point expansions: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", 1997). On the edge itself, the ray is shifted by (e, e^2) with e infinitely small and
/// positive: the sign is then that of dE/dx, or, if this is zero, of dE/dy. 0 remains only if a and b are on one line
/// through the eye: this edge has no sides, and no face with it is hit. edge_sign(a, b) = -edge_sign(b, a).
///
/// `on_edge`, if not null, is set to true if E is zero: the ray meets the edge.
int edge_sign(const PixelVertex& a, const PixelVertex& b, double px, double py, double pixels_per_tangent,
              bool* on_edge = nullptr);

/// The largest change by line_of_sight() of a vertex, for px and py below `most_pixels`: a bound of the change of
/// X - px w and Y - py w, with w before rounding.
double sight_error(const PixelVertex& v, double pixels_per_tangent, double most_pixels);

}  // namespace tessera::projection
