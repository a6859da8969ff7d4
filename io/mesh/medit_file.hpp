// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::io {

/// Parses a Medit mesh in text form: numbers and keywords separated by blanks and comments. Supports the same cells as
/// the binary form, makes the same blocks and refuses files for the same reasons. The numbers of MeshVersionFormatted
/// and Dimension may be on the line of the keyword or after it. Numbers of all other keywords are skipped.
std::vector<cells::CellBlock> parse_medit_text(std::string_view text, const std::string& source);

/// Parses a binary Medit mesh of linear tetrahedra, pyramids, prisms and hexahedra, and second-order tetrahedra. The
/// cells of each reference number become a block; if there are several blocks, the cell field Reference contains the
/// numbers (cells/block_groups.hpp). Throws Error(bad_input) with the position and a remedy for damaged files,
/// two-dimensional meshes and unsupported cells. Allocates nothing before the file is known to be long enough.
///
/// Layout  1 (int32), version (int32), then keywords: code (int32), position of the next keyword (int32, from version 3
///         int64), contents. Lists begin with their length. Integers are int32, in version 4 int64; reals are float in
///         version 1, double in later versions. A point consists of its coordinates and a reference; a cell consists of
///         the numbers of its points, counted from 1, and a reference.
/// Source  L. Marechal, "The libMeshb library", INRIA, 2018 (its formats and keywords).
std::vector<cells::CellBlock> parse_medit_binary(std::span<const std::byte> bytes, const std::string& source);

}  // namespace tessera::io
