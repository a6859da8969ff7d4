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

/// The volume cells that Gmsh has read, each in one block: in the first chosen group that contains it, otherwise in its
/// smallest physical group, and one more block for cells without a group. Views are their fields (NaN where one has no
/// value); if there are several groups or partitions, the cell fields PhysicalGroupId and PartitionId are added. If a
/// view has values for the nodes of each cell, each cell has its own points. `file` as in gmsh_volumes(). If a chosen
/// name does not exist, all cells are chosen, and the caller reports the error. Throws Error(bad_input) for a missing
/// node.
GmshBlocks gmsh_blocks(const std::vector<GmshView>& views, const cells::BlockChoice& choice,
                       const std::filesystem::path& file, const std::string& source, std::vector<std::string>& notes);

}  // namespace tessera::readers
