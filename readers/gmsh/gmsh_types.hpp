// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tessera::readers {

/// A Gmsh element type.
struct GmshElementType {
  std::string name;
  int order = 0;
  std::size_t nodes = 0;       ///< 0: unknown
  std::size_t corners = 0;     ///< 0: unknown
  std::vector<double> places;  ///< node positions as in gmsh_cell(); incomplete if the dimension is below 3
};

/// Returns the description by Gmsh's library. Version 4.8 does not describe prisms of third or higher order. For these,
/// this function adds the nodes of complete prisms, and for other prisms only the corners.
GmshElementType gmsh_element_type(int type);

}  // namespace tessera::readers
