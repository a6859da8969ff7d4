#pragma once

#include <string>
#include <vector>

#include "io/cell_block.hpp"
#include "io/helper/gmsh_views.hpp"

namespace tessera::io::helper {

/// The volume cells of what Gmsh has read, a block for each physical group and one for those in none, with the views as
/// their fields (NaN where one has no value) and, of several groups, the cell field PhysicalGroupId. Where a view has
/// values of cells' nodes, each cell has points of its own. Throws Error(bad_input) for a node that is not there.
std::vector<CellBlock> gmsh_blocks(const std::vector<GmshView>& views, const std::string& source,
                                   std::vector<std::string>& notes);

}  // namespace tessera::io::helper
