// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

class XdmfTopology;

namespace tessera::readers {

/// Cells in VTK's form.
struct XdmfCells {
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets;
  std::vector<std::uint32_t> connectivity;  ///< the largest value replaces indices that do not fit
};

/// Registers the documented names of second-order cells, "Tet_10" ..., with Xdmf's library. The library itself supports
/// only other names, "Tetrahedron_10" ...
void add_cell_names();

/// Converts the cells of a topology whose numbers have been read. XDMF numbers nodes like VTK, even in higher-order
/// cells. Throws Error(bad_input) for cells without a VTK type, and for numbers that end within a cell.
XdmfCells cells_of(XdmfTopology& topology, const std::string& where);

}  // namespace tessera::readers
