// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::io {

/// Parses a Medit mesh in text: numbers and keywords with any blanks and comments between, of the same cells as in
/// binary, in the same blocks, refused for the same reasons. Version and Dimension may be on one line with the keyword
/// or not, and the numbers of all other keywords are passed over.
std::vector<cells::CellBlock> parse_medit_text(std::string_view text, const std::string& source);

/// Parses a binary Medit mesh: tetrahedra, pyramids, prisms and hexahedra, of the second order tetrahedra alone; a
/// block a reference, which the cell field Reference has where there are several (cells/block_groups.hpp). Throws
/// Error(bad_input) with the place and a remedy for what is damaged, has two dimensions or cells that are not read.
/// Nothing is allocated before the file is long enough to hold it.
///
/// Layout  1 (int32), version (int32), then keywords: code (int32), where the next keyword begins (int32, from version
///         3 int64), what it has. Of lists the length first; whole numbers are int32, in version 4 int64; reals are
///         float in version 1, double later. Of each point its coordinates and a reference, of each cell its points
///         from 1 and a reference.
/// Source  L. Marechal, "The libMeshb library", INRIA, 2018 (its formats and keywords).
std::vector<cells::CellBlock> parse_medit_binary(std::span<const std::byte> bytes, const std::string& source);

}  // namespace tessera::io
