// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/vtk/vtu_cells.hpp"

namespace tessera::io {

/// Adds the faces of polyhedra, if a piece has any, as written up to version 2.2 of the format (`faces`, the list of
/// faces of each cell, and `faceoffsets`, where the lists end) or from 2.3 on (a separate list of faces, and the face
/// numbers of each cell). Throws Error(bad_input) naming `source`.
void add_vtu_faces(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source,
                   VtuCells& cells);

}  // namespace tessera::io
