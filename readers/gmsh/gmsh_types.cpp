// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_types.hpp"

#include <gmsh.h>

#include <algorithm>
#include <new>

#include "readers/gmsh/gmsh_cells.hpp"

namespace tessera::readers {

GmshElementType gmsh_element_type(int type) {
  GmshElementType found;
  int dimension = 0, nodes = 0, corners = 0;
  try {
    gmsh::model::mesh::getElementProperties(type, found.name, dimension, found.order, nodes, found.places, corners);
    found.nodes = static_cast<std::size_t>(std::max(nodes, 0));
    found.corners = static_cast<std::size_t>(std::max(corners, 0));
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {  // Gmsh throws objects of any type
    found = {};
    const bool is_third_or_fourth = type == 90 || type == 91;
    if (!is_third_or_fourth && (type < 106 || type > 117)) return found;
    found.name = "Prism", found.corners = 6;
    found.order = is_third_or_fourth ? type - 87 : type <= 110 ? type - 101 : 0;  // types above 110 have no inner nodes
    if (found.order > 0) found.places = gmsh_prism_places(found.order);
    found.nodes = found.places.size() / 3;
  }
  return found;
}

}  // namespace tessera::readers
