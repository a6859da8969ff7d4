// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::cells {

/// Bits of vtkGhostType (vtkDataSetAttributes.h: CellGhostTypes, PointGhostTypes).
inline constexpr std::uint8_t duplicate_cell = 1, refined_cell = 8, hidden_cell = 32, hidden_point = 2;

}  // namespace tessera::cells
