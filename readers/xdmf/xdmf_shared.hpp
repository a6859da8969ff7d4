// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <set>
#include <vector>

#include "readers/xdmf/xdmf_grids.hpp"

class XdmfArray;

namespace tessera::readers {

/// The arrays that a grid's points and cells are in; null where one is not there.
std::vector<XdmfArray*> mesh_arrays(XdmfGrid& grid);

/// Grids of one mesh, which the file includes or names again for each field, become one block with the fields of all:
/// those of FEniCS are a grid of the mesh and a series for each function. A field whose name the block has already
/// keeps its grid apart.
void merge_same_meshes(std::vector<XdmfBlock>& blocks);

/// Arrays that several of the blocks use; they must not be released after the first.
std::set<const XdmfArray*> shared_arrays(const std::vector<XdmfBlock>& blocks);

}  // namespace tessera::readers
