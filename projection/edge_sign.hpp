// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "projection/pixel_space.hpp"

namespace tessera::projection {

/// The line from the eye through a vertex, in homogeneous pixel coordinates. With (x, y) the pixel position of the
/// vertex, the line is (x, y, 1) if the vertex is in front of the eye, and (-x, -y, -1) if it is behind the eye. It is
/// (X, Y, 0) if the vertex is in the eye plane, which is the plane through the eye parallel to the image.
struct LineOfSight {
  double x, y, w;
};

/// Returns the position of a vertex for the tie rule. Positions are rounded: a vertex that is meant to be on a pixel
/// centre, or in the plane through the eye and a row or column of centres, is exactly there, in spite of the rounding
/// errors of decimal coordinates, of the camera's axes and of the projection. The rule then decides in the same way
/// along a whole edge, side or plane of a mesh.
///   - Orthographic (pixels_per_tangent 0): positions are multiples of 2^-32 pixel, as PixelSpace has rounded them.
///   - Perspective: positions are multiples of 2^-32 pixel or of a power of two, whichever is greater. This power of
///     two is the one in (2^-47, 2^-46] times the largest of |x|, |y| and min(pixels per tangent, 2^22). It is the
///     greater of the two if that largest value is 2^15 or more: outside of the image, towards the eye plane, and with
///     long lenses, where rounding errors are also greater.
///   - A vertex 2^46 or more pixels away is moved to the eye plane. X and Y are then both rounded to multiples of the
///     power of two in (2^-41, 2^-40] times the larger of them.
/// Only the vertex and the view are used, so that the vertex has the same position in all cells. Rounding only affects
/// on which side of an edge a ray passes: perspective depths and scalars are computed at the position before rounding,
/// at most 2^-33 pixel away.
LineOfSight line_of_sight(const PixelVertex& v, double pixels_per_tangent);

/// Determines exactly on which side of the edge a -> b the ray through pixel position (px, py) passes.
///
/// Returns the sign, -1, 0 or +1, of the determinant E = | (px, py, 1) ; a ; b | of the vertices' lines of sight, in
/// exact arithmetic (floating-point expansions: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
/// Geometric Predicates", 1997). If the ray meets the edge itself, it is shifted by (e, e^2) with e infinitely small
/// and positive: the sign is then that of dE/dx, or, if this is zero, of dE/dy. The result is 0 only if a and b are on
/// one line through the eye: this edge has no sides, and no face with this edge is hit. Swapping a and b changes the
/// sign.
///
/// If `on_edge` is not null, it is set to whether E is zero, that is, whether the ray meets the edge.
int edge_sign(const PixelVertex& a, const PixelVertex& b, double px, double py, double pixels_per_tangent,
              bool* on_edge = nullptr);

/// Returns how much line_of_sight() can change a vertex: an upper bound of the change of X - px w and Y - py w, for px
/// and py below `most_pixels`, with w before rounding.
double sight_error(const PixelVertex& v, double pixels_per_tangent, double most_pixels);

}  // namespace tessera::projection
