// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/vtk/vtu_cells.hpp"

namespace tessera::io {

/// Adds the faces of polyhedra, if a piece has any. Up to version 2.2 of the format they are stored as `faces`, the
/// list of faces of each cell, and `faceoffsets`, where the lists end; from 2.3 on, as a separate list of faces, and
/// the face numbers of each cell. Throws Error(bad_input) naming `source`.
void add_vtu_faces(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source,
                   VtuCells& cells);

}  // namespace tessera::io
