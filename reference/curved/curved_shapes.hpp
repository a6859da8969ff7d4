// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "reference/bernstein.hpp"

namespace tessera::reference {

/// The shape functions of one of VTK's cell types, of given orders.
///
/// A type is defined here by its nodes and by the space of polynomials that its shape functions span. Each shape
/// function is one at its own node and zero at the others. Shape functions are stored as Bernstein coefficients: a
/// cell's control points are the product of `to_bernstein` and its nodes' positions, and likewise for the field.
struct CellShape {
  BernsteinBasis basis;
  std::vector<glm::dvec3> nodes;  ///< places in the cell's own coordinates, in VTK's order
  Matrix to_bernstein;            ///< basis.size() x nodes.size()
  std::vector<FacePatch> faces;
};

/// Returns the shape for a type, a number of nodes and orders. `orders` are those of VTK's array HigherOrderDegrees. If
/// they are zeros, the orders are derived from the number of nodes, as in VTK. Only Lagrange and Bezier hexahedra and
/// wedges use them.
///
/// Types   linear 10 to 14; quadratic 24 to 27, 29, 31 to 33, 37; Lagrange 71 to 74, with the tet of 15 nodes, the
///         wedge of 21, and cells with some of these nodes (tets of 5, 7, 8, 11 and 14, hexahedra of 9, 16, 21 and 26,
///         wedges of 16 and 20); Bezier 78 to 80, of unit weights.
/// Throws  scene::Error(bad_input), which begins with `where`, for other types, wrong numbers of nodes and orders above
///         10.
CellShape cell_shape(std::uint8_t vtk_type, std::size_t nodes, std::array<int, 3> orders, const std::string& where);

/// Whether cells of this type have no volume: vertices, lines, polygons.
bool without_volume(std::uint8_t vtk_type);

/// Evaluates the shape functions at a place: one value per node.
std::vector<double> shape_functions(const CellShape& shape, const glm::dvec3& place);

}  // namespace tessera::reference
