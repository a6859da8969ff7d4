// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

namespace tessera::readers {

/// First and last point along each axis; the cells are between them.
using Extent = std::array<int, 6>;

bool holds(const Extent& extent, const Extent& part);

/// 0 if it is flat or empty.
double cells_in(const Extent& extent);

/// Number of cells in the union of the pieces, however these overlap.
double cells_covered(std::span<const Extent> pieces);

/// The smallest extent that contains all pieces.
Extent box_of(std::span<const Extent> pieces);

/// The six numbers as text.
std::string words_of(const Extent& extent);

}  // namespace tessera::readers
