// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::cells {

/// Divides a block of cells, without faces and fields, by a number that each cell has. The cells with the same number
/// become a block named "WORD NUMBER", with the points that they use and a cell field `field` that contains the number;
/// blocks are in ascending order of the numbers. If all numbers are equal, the result is one block without name and
/// field; if there are more than 256 numbers, it is one block with the field.
std::vector<CellBlock> blocks_by_number(const CellBlock& all, std::span<const std::int64_t> numbers,
                                        const std::string& word, const std::string& field);

}  // namespace tessera::cells
