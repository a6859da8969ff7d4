// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::io {

/// Parses an SU2 mesh: a block for each zone, of its NELEM volume cells (cell types are VTK's) and NPOIN points;
/// markers and free-form boxes are passed over. Nothing is allocated before the text is long enough to hold it; all
/// indices are checked. Throws Error(bad_input) with file, line and remedy, for two-dimensional meshes too.
///
/// Source  SU2's documentation, "Mesh File" (su2code.github.io/docs_v7/Mesh-File).
std::vector<cells::CellBlock> parse_su2(std::string_view text, const std::string& source);

}  // namespace tessera::io
