// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <span>
#include <string>

namespace tessera::readers {

/// First and last point index along each axis. Cells are between these points.
using Extent = std::array<int, 6>;

bool holds(const Extent& extent, const Extent& part);

/// Returns the number of cells; 0 if the extent is flat or empty.
double cells_in(const Extent& extent);

/// Returns the number of cells in the union of the pieces, which may overlap.
double cells_covered(std::span<const Extent> pieces);

/// Returns the smallest extent that contains all pieces.
Extent box_of(std::span<const Extent> pieces);

/// Returns the six numbers as text.
std::string words_of(const Extent& extent);

}  // namespace tessera::readers
