// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/vtk/vtk_xml_grid.hpp"

namespace tessera::io {

/// The cells of all pieces of a .vtu, without their point indices unless these must be reordered. Points are numbered
/// consecutively across the pieces.
struct VtuCells {
  std::vector<std::uint8_t> types;
  std::vector<std::uint64_t> offsets;        ///< cells + 1
  std::vector<std::uint64_t> uses;           ///< number of point indices in the cells of each piece
  std::vector<std::uint32_t> connectivity;   ///< empty if it is the same as in the file
  std::vector<std::uint32_t> faces;          ///< faces of polyhedra, in the format of CellBlock
  std::vector<std::int64_t> face_locations;  ///< one per cell; empty if there are no polyhedra
  bool are_tets = false;                     ///< all cells are tets
};

/// Reads types, offsets and faces, and checks that the file is large enough for the point indices of the cells.
/// Reorders the nodes of higher-order hexahedra of files before version 2.1 to the order of later versions. Throws
/// Error(bad_input) naming `source`.
VtuCells read_vtu_cells(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source);

/// Returns an array of a piece's cells. Throws Error(bad_input) if the array is missing.
const VtkXmlArray& topology_of(const VtkXmlGrid& grid, std::size_t piece, const char* name, const std::string& source);

/// Returns the number of a point in the whole file, given its number in a piece whose points begin at `first`; the
/// largest uint32 if `in_piece` is invalid.
inline std::uint32_t point_number(std::int64_t in_piece, std::uint64_t first) {
  const std::uint64_t number = static_cast<std::uint64_t>(in_piece) + first;
  return in_piece < 0 || number > UINT32_MAX ? UINT32_MAX : static_cast<std::uint32_t>(number);
}

}  // namespace tessera::io
