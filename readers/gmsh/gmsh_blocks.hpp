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
  std::vector<std::string> names;  ///< names of all physical groups and partitions, which may share cells
};

/// Returns the volume cells that Gmsh has read. Each cell is in one block: that of the first chosen group that contains
/// the cell, otherwise that of its smallest physical group; one more block contains the cells without a group. Views
/// become fields, which are NaN where a view has no value. If there are several groups or partitions, the cell fields
/// PhysicalGroupId and PartitionId are added. If a view has values for the nodes of each cell, each cell has its own
/// points. `file` is as in gmsh_volumes(). If a chosen name does not exist, all cells are chosen, and the caller
/// reports the error. Throws Error(bad_input) for a missing node.
GmshBlocks gmsh_blocks(const std::vector<GmshView>& views, const cells::BlockChoice& choice,
                       const std::filesystem::path& file, const std::string& source, std::vector<std::string>& notes);

}  // namespace tessera::readers
