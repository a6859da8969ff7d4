// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class XdmfTopology;

namespace tessera::readers {

/// Cells as VTK has them.
struct XdmfCells {
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets;
  std::vector<std::uint32_t> connectivity;  ///< the largest number stands for what it cannot hold
};

/// Makes Xdmf's library know the names of second-order cells that its documentation gives, "Tet_10" ..., besides its
/// own, "Tetrahedron_10" ...
void add_cell_names();

/// The cells of a topology whose numbers are read. XDMF numbers nodes as VTK does, those of higher-order cells too.
/// Throws Error(bad_input) for cells that VTK has no type of, and numbers that end within a cell.
XdmfCells cells_of(XdmfTopology& topology, const std::string& where);

}  // namespace tessera::readers
