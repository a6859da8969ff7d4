#pragma once

#include <string>
#include <vector>

#include "io/cell_block.hpp"
#include "io/mesh_reader.hpp"

namespace tessera::io {

/// Makes the tet mesh of a file's blocks: chooses the field, drops ghost, hidden and NaN cells, splits the rest.
/// Blocks are emptied as they are used, so that no more than one copy of anything is held. `format` is left empty.
/// Throws Error(bad_input) in one line that begins with `source`.
MeshFile assemble_mesh(std::vector<CellBlock> blocks, const MeshOptions& options, const std::string& source);

/// Replaces cell data by point data: each used vertex gets the mean of the cells that touch it, weighted by tet volume
/// (unweighted where all volumes are 0). Vertices at one position count as one, so that pieces leave no seam.
void smooth_to_points(scene::TetMesh& mesh);

}  // namespace tessera::io
