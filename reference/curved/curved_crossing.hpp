// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "reference/bernstein.hpp"
#include "reference/mesh/cell_on_ray.hpp"

namespace tessera::reference {

/// The intersection of a ray with a face of a cell.
struct Crossing {
  double depth;      ///< planar
  glm::dvec3 place;  ///< in the cell's own coordinates
};

/// Appends every crossing of the ray with a face, unordered. A crossing at an edge or a corner of the face may be found
/// twice. A crossing outside the face may be found if its distance from an edge is at most 1e-9 of the face's size.
///
/// How      Pieces of the face whose control points are on one side of the ray (along eight directions) are dropped, as
///          are pieces that are a point, or a line along the ray, up to rounding. The others are halved until the map
///          of a piece to the plane across the ray is one-to-one (all control vectors of its derivatives are close to
///          their mean). Then Newton's method finds the only crossing of the piece, or that there is none. Only
///          crossings within rounding of a tangent may be missed: see below.
/// Limits   Pieces smaller than 2^-26 of the face are not halved further. After 4,000 pieces, the remaining ones are
///          dropped: they are faces along the ray, or contain curves along the ray. Two crossings that are closer to
///          each other than the size of such a piece bound a negligible length.
/// Source   Nishita, Sederberg, Kakimoto, "Ray Tracing Trimmed Rational Surface Patches", SIGGRAPH 1990, for the frame
///          and the hull; the one-to-one test is Krawczyk's, as in Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH
///          1985.
void find_crossings(const CellOnRay& cell, const FacePatch& face, std::vector<Crossing>& crossings);

}  // namespace tessera::reference
