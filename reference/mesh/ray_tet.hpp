// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "reference/view.hpp"

namespace tessera::reference {

/// One vertex of a tetrahedron, projected, with its scalar.
struct Corner {
  ProjectedVertex vertex;
  double scalar;
};

/// The stretch of a line inside a tetrahedron: planar depths front <= back and the scalars there. These are kept as
/// differences to the scalar of one corner besides: a sum would round away how far a scalar is from a step of the
/// transfer function that it all but equals, and on which side.
struct Stretch {
  double front, back;
  double scalar_front, scalar_back;
  double corner_scalar, change_front, change_back;
  int face_front = -1, face_back = -1;  ///< whose corner opposite has this index; -1: it ends at no face
};

/// Where the line (not only the half in front of the eye) through pixel coordinates (x, y) passes through a
/// tetrahedron; nothing if it does not.
///
/// Corners  in lexicographic order of their world positions, so that two cells that share a face compute the same
///          numbers on it.
/// Decision exact, on rounded lines of sight (view.hpp). Three of them, A, B and (x, y), are on one plane where E =
///          det[(x,y,1), A, B] = 0; the line passes through a triangle ABC iff E_ab, E_bc and E_ca have one sign.
///          Depths and scalars are those of the corners as they are. Where E is exactly zero (the line goes through the
///          edge) the sign is that of the line shifted by (e, e^2) pixel in (x, y), e positive and infinitely small. So
///          among cells that tile space every line, through vertices and edges or in faces, is tiled too. Source of the
///          idea: Edelsbrunner, Muecke, "Simulation of Simplicity", ACM TOG 1990.
/// Faces    coplanar with the eye (they project to a line) are never hit.
/// Eye      on the cell's surface: the line then hits only one other face, and the stretch ends at depth 0 at the eye.
/// Flat     cells give stretches of length zero, up to rounding.
std::optional<Stretch> intersect(const std::array<Corner, 4>& corners, double x, double y);

/// Where a line meets a triangle, decided as above: among triangles that meet in edges every line through one is met
/// once. Nothing if it does not, and where the eye lies in the triangle's plane.
struct TriangleHit {
  double depth, scalar;
};
std::optional<TriangleHit> intersect(const std::array<Corner, 3>& corners, double x, double y);

/// What of a stretch lies between two planar depths; nothing if nothing of it lies strictly between them. A stretch of
/// length zero between them stays.
std::optional<Stretch> clipped(const Stretch& stretch, double nearest, double farthest);

}  // namespace tessera::reference
