// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tessera::readers {

/// An element type of Gmsh's.
struct GmshElementType {
  std::string name;
  int order = 0;
  std::size_t nodes = 0;       ///< 0: not known
  std::size_t corners = 0;     ///< 0: not known
  std::vector<double> places;  ///< as gmsh_cell() takes them; fewer than the nodes where the dimension is below 3
};

/// As Gmsh's library describes it. The library of 4.8 does not describe prisms of the third order and above; of those
/// with all their nodes this knows everything, of the others the corners.
GmshElementType gmsh_element_type(int type);

}  // namespace tessera::readers
