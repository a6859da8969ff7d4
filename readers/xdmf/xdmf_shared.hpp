// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "readers/xdmf/xdmf_grids.hpp"

class XdmfArray;

namespace tessera::readers {

/// The arrays of a grid's points and cells; null where one is missing.
std::vector<XdmfArray*> mesh_arrays(XdmfGrid& grid);

/// Merges grids of one mesh, which the file includes or names again for each field, into one block with all fields:
/// FEniCS writes a grid for the mesh and a series for each function. A grid with a field whose name the block already
/// has stays separate.
void merge_same_meshes(std::vector<XdmfBlock>& blocks);

/// Arrays used by several of the blocks; they must not be released after the first.
std::set<const XdmfArray*> shared_arrays(const std::vector<XdmfBlock>& blocks);

}  // namespace tessera::readers
