// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessera/cell_type.hpp"

namespace tessera::readers {

/// Conversion of a Gmsh element to a VTK cell.
struct GmshCell {
  CellType type = CellType::empty_cell;
  std::vector<std::size_t> nodes;  ///< for each of VTK's nodes, in VTK's order, the index of Gmsh's node
  bool by_corners = false;         ///< the type is not supported; the linear cell between its corners is used
};

/// Matches nodes by their positions in the reference cell. `places` contains Gmsh's positions, u v w per node
/// (tetrahedra in the unit tetrahedron, hexahedra in [-1, 1]^3, prisms between w = -1 and 1, pyramids over [-1, 1]^2).
/// The first `corners` nodes are the corners.
GmshCell gmsh_cell(int order, std::size_t corners, std::span<const double> places);

/// Returns the node positions of a complete prism of third or higher order, which Gmsh's library 4.8 does not report.
/// They are those of the nodes in prisms that the library creates: corners, edges, the inside of triangles and
/// quadrilaterals, numbered like a smaller triangle or quadrilateral, and the inside of the cell, one vertical line
/// after the other.
std::vector<double> gmsh_prism_places(int order);

}  // namespace tessera::readers
