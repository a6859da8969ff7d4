// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "reference/bernstein.hpp"

namespace tessera::reference {

/// The places of the nodes of VTK's cells in the cell's own coordinates, in VTK's order (9.1): corners, then nodes in
/// edges, in faces, inside.
///
/// Pyramids are in a box whose face t = 1 is the apex (its node is (0, 0, 1)): a node at height t has the r and s of
/// its projection from the apex to the base.

/// A tet of that order (VTK's Lagrange tetrahedron; for order 2 also the quadratic one).
std::vector<glm::dvec3> tet_nodes(int order);

/// A wedge: `order` in the triangle, `order_along` between the triangles.
std::vector<glm::dvec3> wedge_nodes(int order, int order_along);

/// A hexahedron of `orders` along its axes. The first 8, 20 or 24 of those of order 2 are the nodes of other types.
std::vector<glm::dvec3> hexahedron_nodes(std::array<int, 3> orders);

/// A pyramid of 19 nodes. The first 5 or 13 are those of other types.
std::vector<glm::dvec3> pyramid_nodes();

/// A Lagrange pyramid, for which VTK has a type number but no node order. Here: corners; edges, from the lower corner
/// to the higher along r and s as in a hexahedron, then up to the apex; the base, rows along r; the triangles over the
/// base's edges, rows from the base up along the edge; the inside, layers from the base up, rows along r.
std::vector<glm::dvec3> lagrange_pyramid_nodes(int order);

}  // namespace tessera::reference
