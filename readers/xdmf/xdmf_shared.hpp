// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "readers/xdmf/xdmf_grids.hpp"

class XdmfArray;

namespace tessera::readers {

/// Returns the arrays of a grid's points and cells. An entry is null if the array is missing.
std::vector<XdmfArray*> mesh_arrays(XdmfGrid& grid);

/// Merges grids of the same mesh into one block with the fields of all these grids. Some files repeat the mesh for each
/// field, by inclusion or by reference: FEniCS writes a grid for the mesh and a series for each function. A grid stays
/// separate if it has a field whose name the block already has.
void merge_same_meshes(std::vector<XdmfBlock>& blocks);

/// Returns the arrays that several of the blocks use. These must not be released after the first use.
std::set<const XdmfArray*> shared_arrays(const std::vector<XdmfBlock>& blocks);

}  // namespace tessera::readers
