// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "reference/bernstein.hpp"
#include "reference/mesh/cell_on_ray.hpp"

namespace tessera::reference {

/// Where a ray passes through a face of a cell.
struct Crossing {
  double depth;      ///< planar
  glm::dvec3 place;  ///< in the cell's own coordinates
};

/// Appends every crossing of the ray with a face, in no order; one at an edge or a corner of the face may be found
/// twice, and one up to 1e-9 of the face beyond its edge too.
///
/// How      pieces of the face whose control points lie to one side of the ray (along eight directions) are dropped,
///          as are those that are a point, or a line along the ray, to rounding. The others are halved until the map of
///          a piece to the plane across the ray is one to one (its derivatives' control vectors all near their mean),
///          where Newton's method finds its one crossing or none. Nothing is missed that is not within rounding of a
///          tangent: see below.
/// Limits   pieces of less than 2^-26 of the face are halved no more; what is left after 4,000 pieces is dropped:
///          faces, or curves of them, that lie along the ray. Two crossings nearer to each other than such a piece
///          bound no length that counts.
/// Source   Nishita, Sederberg, Kakimoto, "Ray Tracing Trimmed Rational Surface Patches", SIGGRAPH 1990, for the frame
///          and the hull; the test of one to one is Krawczyk's, as in Toth, "On Ray Tracing Parametric Surfaces",
///          SIGGRAPH 1985.
void find_crossings(const CellOnRay& cell, const FacePatch& face, std::vector<Crossing>& crossings);

}  // namespace tessera::reference
