// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtu_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "cells/curved/node_orders.hpp"
#include "io/vtk/vtk_xml_numbers.hpp"
#include "io/vtk/vtu_faces.hpp"
#include "scene/error.hpp"
#include "system/large_vector.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io {
namespace {

constexpr std::uint8_t tetrahedron = vtk_number(CellType::tetra);
/// VTK's type numbers of hexahedra of arbitrary order: the oldest type (67), Lagrange and Bezier.
constexpr std::array<std::uint8_t, 3> higher_order_hexahedra = {67, vtk_number(CellType::lagrange_hexahedron),
                                                                vtk_number(CellType::bezier_hexahedron)};

bool is_higher_order_hexahedron(std::uint8_t type) { return std::ranges::count(higher_order_hexahedra, type) > 0; }

void add_types(const system::PositionalFile& file, const VtkXmlSegment& types, const std::string& source,
               VtuCells& cells) {
  stream_whole_numbers(file, types, 1, source, [&](std::span<const std::int64_t> part) {
    for (const std::int64_t type : part) cells.types.push_back(static_cast<std::uint8_t>(type));
  });
}

/// Reads offsets; the file stores the end of each cell.
void add_offsets(const system::PositionalFile& file, const VtkXmlSegment& ends, const std::string& source,
                 VtuCells& cells) {
  const std::uint64_t first = cells.offsets.back();
  std::int64_t last = 0;
  stream_whole_numbers(file, ends, 1, source, [&](std::span<const std::int64_t> part) {
    for (const std::int64_t end : part) {
      if (end < last)
        throw scene::bad_input(
            fmt::format("{}: the offset of cell {} is {}, less than the one before, {}; the file is "
                        "damaged, export it again",
                        source, cells.offsets.size() - 1, end, last));
      last = end;
      cells.offsets.push_back(first + static_cast<std::uint64_t>(end));
    }
  });
  cells.uses.push_back(static_cast<std::uint64_t>(last));
}

bool all_are_tets(const VtuCells& cells) {
  if (cells.types.empty() || !std::ranges::all_of(cells.types, [](std::uint8_t t) { return t == tetrahedron; }))
    return false;
  for (std::size_t c = 0; c < cells.offsets.size(); ++c)
    if (cells.offsets[c] != 4 * c) return false;
  return true;
}

/// Returns VTK's HigherOrderDegrees of a piece's cells; empty if the piece does not have that array.
std::vector<std::array<int, 3>> degrees_of(const system::PositionalFile& file, const VtkXmlPiece& piece,
                                           const std::string& source) {
  const auto& arrays = piece.cell_fields.arrays;
  const auto found = std::ranges::find(arrays, "HigherOrderDegrees", &VtkXmlArray::name);
  std::vector<std::array<int, 3>> degrees;
  if (found == arrays.end() || found->components != 3) return degrees;
  degrees.resize(piece.cells);
  std::size_t at = 0;
  stream_whole_numbers(file, {*found, 3 * piece.cells}, 1, source, [&](std::span<const std::int64_t> part) {
    for (const std::int64_t number : part) {
      degrees[at / 3][at % 3] = number > 0 && number < 1000 ? static_cast<int>(number) : 0;
      ++at;
    }
  });
  return degrees;
}

void add_reordered(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source,
                   VtuCells& cells) {
  std::uint64_t first = 0, cell = 0;
  system::reserve_large(cells.connectivity, cells.offsets.back());
  for (std::size_t p = 0; p < grid.pieces.size(); first += grid.pieces[p++].points) {
    if (cells.uses[p] > 0) {
      const VtkXmlSegment uses{topology_of(grid, p, "connectivity", source), cells.uses[p]};
      stream_whole_numbers(file, uses, 1, source, [&](std::span<const std::int64_t> part) {
        for (const std::int64_t point : part) cells.connectivity.push_back(point_number(point, first));
      });
    }
    const auto degrees = degrees_of(file, grid.pieces[p], source);
    for (std::uint64_t c = 0; c < grid.pieces[p].cells; ++c, ++cell)
      if (is_higher_order_hexahedron(cells.types[cell]))
        cells::exchange_vtk8_edges(
            std::span(cells.connectivity).subspan(cells.offsets[cell], cells.offsets[cell + 1] - cells.offsets[cell]),
            degrees.empty() ? std::array<int, 3>{} : degrees[c]);
  }
}

}  // namespace

const VtkXmlArray& topology_of(const VtkXmlGrid& grid, std::size_t piece, const char* name, const std::string& source) {
  const VtkXmlArray* const array = grid.pieces[piece].find(name);
  if (array == nullptr || array->components != 1)
    throw scene::bad_input(
        fmt::format("{}: the cells of its piece {} have no one-component array '{}'; the file "
                    "is damaged, export it again",
                    source, piece, name));
  return *array;
}

VtuCells read_vtu_cells(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source) {
  VtuCells cells;
  cells.offsets.push_back(0);
  std::uint64_t count = 0;
  for (std::size_t p = 0; p < grid.pieces.size(); ++p) {
    const std::uint64_t of_piece = grid.pieces[p].cells;
    count += of_piece;
    for (const char* name : {"types", "offsets"})
      if (of_piece > 0) require_numbers(file, {topology_of(grid, p, name, source), of_piece}, source);
  }
  system::reserve_large(cells.types, count);
  system::reserve_large(cells.offsets, count + 1);
  for (std::size_t p = 0; p < grid.pieces.size(); ++p) {
    if (grid.pieces[p].cells == 0) {
      cells.uses.push_back(0);
      continue;
    }
    add_types(file, {topology_of(grid, p, "types", source), grid.pieces[p].cells}, source, cells);
    add_offsets(file, {topology_of(grid, p, "offsets", source), grid.pieces[p].cells}, source, cells);
    require_numbers(file, {topology_of(grid, p, "connectivity", source), cells.uses.back()}, source);
  }
  cells.are_tets = all_are_tets(cells);
  add_vtu_faces(file, grid, source, cells);
  const bool is_old = grid.major < 2 || (grid.major == 2 && grid.minor < 1);
  if (is_old && std::ranges::any_of(cells.types, is_higher_order_hexahedron)) add_reordered(file, grid, source, cells);
  return cells;
}

}  // namespace tessera::io
