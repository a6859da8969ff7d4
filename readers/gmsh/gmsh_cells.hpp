// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tessera/cell_type.hpp"

namespace tessera::readers {

/// How an element of Gmsh's becomes a cell of VTK's.
struct GmshCell {
  CellType type = CellType::empty_cell;
  std::vector<std::size_t> nodes;  ///< for each of VTK's nodes, in its order, the number of Gmsh's
  bool by_corners = false;         ///< there is no such cell here: the linear one of its corners
};

/// Nodes are matched by where they lie in the reference cell: `places` are Gmsh's, u v w a node (tetrahedra in the unit
/// one, hexahedra in [-1, 1]^3, prisms between w = -1 and 1, pyramids over [-1, 1]^2), of which the first
/// `corners` are the corners.
GmshCell gmsh_cell(int order, std::size_t corners, std::span<const double> places);

/// The places of a prism of 3rd and higher order with all its nodes, which Gmsh's library of 4.8 does not tell. They
/// are where it puts the nodes of one that it makes itself: corners, edges, then the inside of triangles and
/// quadrilaterals as smaller ones, then of the cell, upright line by upright line.
std::vector<double> gmsh_prism_places(int order);

}  // namespace tessera::readers
