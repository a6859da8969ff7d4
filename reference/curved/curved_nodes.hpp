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
/// Pyramids are in a box whose face t = 1 is the apex; the node at the apex is (0, 0, 1). A node at height t has the r
/// and s of its projection from the apex to the base.

/// Returns the nodes of a tet of this order (VTK's Lagrange tetrahedron; for order 2 also the quadratic one).
std::vector<glm::dvec3> tet_nodes(int order);

/// Returns the nodes of a wedge with `order` in the triangle and `order_along` between the triangles.
std::vector<glm::dvec3> wedge_nodes(int order, int order_along);

/// Returns the nodes of a hexahedron with `orders` along its axes. For order 2, other types have the first 8, 20 or 24
/// of these nodes.
std::vector<glm::dvec3> hexahedron_nodes(std::array<int, 3> orders);

/// Returns the nodes of a pyramid of 19 nodes. Other types have the first 5 or 13 of these nodes.
std::vector<glm::dvec3> pyramid_nodes();

/// Returns the nodes of a Lagrange pyramid, for which VTK has a type number but no node order. The order here is:
/// corners; edges, from the lower corner to the higher along r and s as in a hexahedron, then up to the apex; the base,
/// in rows along r; the triangles over the base's edges, in rows from the base up along the edge; the inside, in layers
/// from the base up, and rows along r.
std::vector<glm::dvec3> lagrange_pyramid_nodes(int order);

}  // namespace tessera::reference
