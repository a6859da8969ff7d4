// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/vtk/vtu_cells.hpp"

namespace tessera::io {

/// Adds the faces of polyhedra, if a piece has any, as VTK writes them up to version 2.2 of the format (`faces`, each
/// cell's list of faces, and `faceoffsets`, where the lists end) or from 2.3 on (faces by themselves, and the numbers
/// of each cell's). Throws Error(bad_input) of `source`.
void add_vtu_faces(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source,
                   VtuCells& cells);

}  // namespace tessera::io
