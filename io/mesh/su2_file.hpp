// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::io {

/// Parses an SU2 mesh: one block per zone, with its NELEM volume cells (VTK's cell types) and NPOIN points; markers and
/// free-form boxes are skipped. Allocates nothing before the text is known to be long enough; checks all indices.
/// Throws Error(bad_input) with file, line and remedy, also for two-dimensional meshes.
///
/// Source  SU2's documentation, "Mesh File" (su2code.github.io/docs_v7/Mesh-File).
std::vector<cells::CellBlock> parse_su2(std::string_view text, const std::string& source);

}  // namespace tessera::io
