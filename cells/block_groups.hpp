// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"

namespace tessera::cells {

/// Divides a block of cells without faces or fields by a number per cell. Each number makes a block, in ascending
/// order, named "WORD NUMBER", with the points used by its cells and the cell field `field` of the numbers. A single
/// number makes one block without name and field, more than 256 make one block with the field.
std::vector<CellBlock> blocks_by_number(const CellBlock& all, std::span<const std::int64_t> numbers,
                                        const std::string& word, const std::string& field);

}  // namespace tessera::cells
