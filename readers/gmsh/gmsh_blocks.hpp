// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "cells/cell_block.hpp"
#include "readers/gmsh/gmsh_views.hpp"

namespace tessera::readers {

struct GmshBlocks {
  std::vector<cells::CellBlock> blocks;
  std::vector<std::string> names;  ///< of all physical groups and partitions, which may share cells
};

/// The volume cells of what Gmsh has read, each in one block: of those chosen by name the first that it is in, else its
/// smallest physical group, and one more for cells in none. Views are their fields (NaN where one has no value); of
/// several groups or partitions there are the cell fields PhysicalGroupId and PartitionId. Where a view has values of
/// cells' nodes, each cell has points of its own. `file` as gmsh_volumes() has it. A choice of a name that is not there
/// chooses all, for the caller to refuse. Throws Error(bad_input) for a node that is not there.
GmshBlocks gmsh_blocks(const std::vector<GmshView>& views, const cells::BlockChoice& choice,
                       const std::filesystem::path& file, const std::string& source, std::vector<std::string>& notes);

}  // namespace tessera::readers
