// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/vtk/vtk_xml_grid.hpp"

namespace tessera::io {

/// What the cells of all pieces of a .vtu are, but for the points that they use, unless these have to be reordered.
/// Points are counted through the pieces.
struct VtuCells {
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets;        ///< cells + 1
  std::vector<std::uint64_t> uses;           ///< of points, by the cells of each piece
  std::vector<std::uint32_t> connectivity;   ///< only where it is not the file's
  std::vector<std::uint32_t> faces;          ///< of polyhedra, as CellBlock has them
  std::vector<std::int64_t> face_locations;  ///< of each cell; empty without polyhedra
  bool are_tets = false;                     ///< all of them, one after the other
};

/// Reads types, offsets and faces, and looks whether the file can hold the points that cells use. Higher-order
/// hexahedra of files before version 2.1 come in the order of nodes of later ones. Throws Error(bad_input) of `source`.
VtuCells read_vtu_cells(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source);

/// The array of a piece's cells. Throws Error(bad_input) if it is not there.
const VtkXmlArray& topology_of(const VtkXmlGrid& grid, std::size_t piece, const char* name, const std::string& source);

/// A point's number in all of the file, of one in a piece whose points begin at `first`; the largest number if it has
/// none.
inline std::uint32_t point_number(std::int64_t in_piece, std::uint64_t first) {
  const std::uint64_t number = static_cast<std::uint64_t>(in_piece) + first;
  return in_piece < 0 || number > UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(number);
}

}  // namespace tessera::io
