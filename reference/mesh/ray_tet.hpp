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

/// The interval of a line inside a tetrahedron: planar depths front <= back and the scalars there. The scalars are also
/// stored as differences to the scalar of one corner, because rounding a sum could move a scalar to the other side of
/// an almost equal step of the transfer function, or change its distance from the step.
struct Stretch {
  double front, back;
  double scalar_front, scalar_back;
  double corner_scalar, change_front, change_back;
  int face_front = -1, face_back = -1;  ///< index of the opposite corner; -1: the interval does not end at a face
};

/// Returns the intersection of the line through pixel coordinates (x, y) with a tetrahedron; no value if there is none.
/// The line includes the half behind the eye.
///
/// Corners  are used in lexicographic order of their world positions, so that two cells that share a face compute the
///          same numbers on it.
/// Decision exact, on rounded lines of sight (view.hpp). The lines of sight to A, to B and through (x, y) are in one
///          plane if E = det[(x,y,1), A, B] = 0. The line through (x, y) passes through a triangle ABC iff E_ab, E_bc
///          and E_ca have the same sign. Depths and scalars are those of the unrounded corners. If E is exactly zero
///          (the line meets the edge), the sign is that of the line shifted by (e, e^2) pixel in (x, y), where e is
///          positive and infinitely small. So if cells tile space, they also tile every line, including lines through
///          vertices, edges or in faces. Source of the idea: Edelsbrunner, Muecke, "Simulation of Simplicity", ACM TOG
///          1990.
/// Faces    coplanar with the eye (they project to a line) are never hit.
/// Eye      on the cell's surface: the line then hits only one other face, and the interval ends at depth 0 at the eye.
/// Flat     cells give intervals of length zero, up to rounding.
std::optional<Stretch> intersect(const std::array<Corner, 4>& corners, double x, double y);

/// The intersection of a line with a triangle, decided by the same rule as for a tetrahedron: if triangles share edges,
/// a line through their union meets exactly one of them. No value if there is no intersection, or if the eye is in the
/// triangle's plane.
struct TriangleHit {
  double depth, scalar;
};
std::optional<TriangleHit> intersect(const std::array<Corner, 3>& corners, double x, double y);

/// Returns the part of an interval between two planar depths; no value if no part is strictly between them. An interval
/// of length zero between them is kept.
std::optional<Stretch> clipped(const Stretch& stretch, double nearest, double farthest);

}  // namespace tessera::reference
