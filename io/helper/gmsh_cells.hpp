#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace tessera::io::helper {

/// How an element of Gmsh's becomes a cell of VTK's.
struct GmshCell {
  std::uint8_t vtk_type = 0;
  std::vector<std::size_t> nodes;  ///< for each of VTK's nodes, in its order, the number of Gmsh's
  bool by_corners = false;         ///< VTK has no such cell: the linear one of its corners
};

/// Nodes are matched by where they lie in the reference cell: `places` are Gmsh's, u v w a node (tetrahedra in the unit
/// one, hexahedra in [-1, 1]^3, prisms between w = -1 and 1, pyramids over [-1, 1]^2), of which the first
/// `corners` are the corners.
GmshCell gmsh_cell(int order, std::size_t corners, std::span<const double> places);

}  // namespace tessera::io::helper
