// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

namespace tessera::readers {

/// Points, first and last along each axis; between them are the cells.
using Extent = std::array<int, 6>;

bool holds(const Extent& extent, const Extent& part);

/// 0 where it is flat or empty.
double cells_in(const Extent& extent);

/// Cells that lie in a piece, however the pieces overlap.
double cells_covered(std::span<const Extent> pieces);

/// The smallest that holds them all.
Extent box_of(std::span<const Extent> pieces);

/// The six numbers.
std::string words_of(const Extent& extent);

}  // namespace tessera::readers
