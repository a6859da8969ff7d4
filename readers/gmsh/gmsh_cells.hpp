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
  std::vector<std::size_t> nodes;  ///< for each of VTK's nodes, in its order, the index of Gmsh's node
  bool by_corners = false;         ///< not supported: uses the linear cell of its corners
};

/// Nodes are matched by their positions in the reference cell: `places` are Gmsh's, u v w per node (tetrahedra in the
/// unit one, hexahedra in [-1, 1]^3, prisms between w = -1 and 1, pyramids over [-1, 1]^2). The first `corners` nodes
/// are the corners.
GmshCell gmsh_cell(int order, std::size_t corners, std::span<const double> places);

/// The node positions of a complete prism of third or higher order, which Gmsh's library 4.8 does not report. They
/// match the nodes of prisms that the library creates: corners, edges, then the inside of triangles and quadrilaterals
/// as smaller ones, then the cell's inside, along vertical lines one by one.
std::vector<double> gmsh_prism_places(int order);

}  // namespace tessera::readers
