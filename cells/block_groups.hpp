// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::cells {

/// Divides a block of cells without faces or fields by a number that each cell has: a block a number, in ascending
/// order, named "WORD NUMBER", with the points that its cells use and the cell field `field` of the numbers. One number
/// makes one block without name and field, more than 256 one with the field.
std::vector<CellBlock> blocks_by_number(const CellBlock& all, std::span<const std::int64_t> numbers,
                                        const std::string& word, const std::string& field);

}  // namespace tessera::cells
