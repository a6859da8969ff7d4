// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::io {

/// Reads the solid elements of a Nastran deck (CTETRA, CPYRAM, CPENTA and CHEXA of order 1 and 2): one block per
/// property, points in the basic coordinate system (nastran_systems.hpp). If an element has mid-edge nodes on only some
/// edges, the other edges get nodes at their midpoints. If there are several blocks, the cell field PropertyId
/// distinguishes them. Throws Error(bad_input) with file, line and remedy.
///
/// Source  MSC Nastran, "Quick Reference Guide", bulk data entries CHEXA, CPENTA, CPYRAM and CTETRA.
std::vector<cells::CellBlock> read_nastran(const std::filesystem::path& file);

}  // namespace tessera::io
