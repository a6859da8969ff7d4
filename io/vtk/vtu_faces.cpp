// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtu_faces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "cells/cell_block.hpp"
#include "io/vtk/vtk_xml_numbers.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// One piece and the cells to which its faces are added.
struct PieceFaces {
  const system::PositionalFile& file;
  const VtkXmlGrid& grid;
  std::size_t piece;
  std::uint64_t first_point;
  std::size_t first_cell;
  const std::string& source;
  VtuCells& cells;

  [[nodiscard]] bool has(const char* name) const { return grid.pieces[piece].find(name) != nullptr; }
  [[nodiscard]] std::vector<std::int64_t> numbers(const char* name, std::uint64_t count) const {
    return whole_numbers(file, {topology_of(grid, piece, name, source), count}, source);
  }
  [[nodiscard]] std::uint64_t cell_count() const { return grid.pieces[piece].cells; }
  [[noreturn]] void refuse(std::size_t cell) const {
    throw scene::bad_input(
        fmt::format("{}: the faces of cell {} do not fit the lists of faces; the file is damaged, "
                    "export it again",
                    source, first_cell + cell));
  }
  void add_count(std::int64_t count) const {
    cells.faces.push_back(static_cast<std::uint32_t>(std::clamp<std::int64_t>(count, 0, UINT32_MAX)));
  }
  void add_face(std::span<const std::int64_t> points) const {
    add_count(static_cast<std::int64_t>(points.size()));
    for (const std::int64_t point : points) cells.faces.push_back(point_number(point, first_point));
  }
  void begin_cell(std::size_t cell) const {
    cells.face_locations[first_cell + cell] = static_cast<std::int64_t>(cells.faces.size());
  }
};

/// Returns the last end of the lists, after checking the ends. Negative ends are ignored.
std::int64_t end_of_lists(const PieceFaces& of, std::span<const std::int64_t> ends) {
  std::int64_t last = 0;
  for (std::size_t c = 0; c < ends.size(); ++c) {
    if (ends[c] < 0) continue;
    if (ends[c] < last) of.refuse(c);
    last = ends[c];
  }
  return last;
}

void add_lists(const PieceFaces& of) {
  const std::vector<std::int64_t> ends = of.numbers("faceoffsets", of.cell_count());
  const std::vector<std::int64_t> lists = of.numbers("faces", static_cast<std::uint64_t>(end_of_lists(of, ends)));
  const std::span<const std::int64_t> all = lists;
  std::size_t at = 0;
  for (std::size_t c = 0; c < ends.size(); ++c) {
    if (ends[c] < 0) continue;
    const auto end = static_cast<std::size_t>(ends[c]);
    if (at == end) of.refuse(c);
    of.begin_cell(c);
    const std::int64_t count = all[at++];
    of.add_count(count);
    for (std::int64_t f = 0; f < count; ++f) {
      if (at >= end || all[at] < 0 || static_cast<std::uint64_t>(all[at]) > end - at - 1) of.refuse(c);
      const auto points = static_cast<std::size_t>(all[at++]);
      of.add_face(all.subspan(at, points));
      at += points;
    }
    if (at != end) of.refuse(c);
  }
}

void add_numbered_faces(const PieceFaces& of) {
  const std::vector<std::int64_t> cell_ends = of.numbers("polyhedron_offsets", of.cell_count());
  const std::vector<std::int64_t> used =
      of.numbers("polyhedron_to_faces", static_cast<std::uint64_t>(end_of_lists(of, cell_ends)));
  std::int64_t faces = 0;
  for (const std::int64_t face : used) faces = std::max(faces, face + 1);
  const std::vector<std::int64_t> face_ends = of.numbers("face_offsets", static_cast<std::uint64_t>(faces));
  const std::vector<std::int64_t> corners =
      of.numbers("face_connectivity", static_cast<std::uint64_t>(end_of_lists(of, face_ends)));
  // At most two cells share a face, so lists of faces are at most twice as long as the faces. The limit prevents a file
  // from creating many copies of a large list.
  const std::size_t most = of.cells.faces.size() + 2 * (corners.size() + face_ends.size()) + cell_ends.size();
  std::size_t at = 0;
  for (std::size_t c = 0; c < cell_ends.size(); ++c) {
    const auto end = static_cast<std::size_t>(std::max<std::int64_t>(cell_ends[c], 0));
    if (end <= at) continue;
    of.begin_cell(c);
    of.add_count(static_cast<std::int64_t>(end - at));
    for (; at < end; ++at) {
      if (used[at] < 0) of.refuse(c);
      const auto face = static_cast<std::size_t>(used[at]);
      const std::int64_t first = face == 0 ? 0 : face_ends[face - 1], last = face_ends[face];
      if (first < 0 || last < first) of.refuse(c);
      if (of.cells.faces.size() + 1 + static_cast<std::size_t>(last - first) > most) of.refuse(c);
      of.add_face(std::span(corners).subspan(static_cast<std::size_t>(first), static_cast<std::size_t>(last - first)));
    }
  }
}

}  // namespace

void add_vtu_faces(const system::PositionalFile& file, const VtkXmlGrid& grid, const std::string& source,
                   VtuCells& cells) {
  std::uint64_t first_point = 0;
  std::size_t first_cell = 0;
  for (std::size_t p = 0; p < grid.pieces.size(); ++p) {
    const PieceFaces of{file, grid, p, first_point, first_cell, source, cells};
    first_point += grid.pieces[p].points;
    first_cell += grid.pieces[p].cells;
    const bool numbered = of.has("face_connectivity") && of.has("face_offsets") && of.has("polyhedron_to_faces") &&
                          of.has("polyhedron_offsets");
    if (of.cell_count() == 0 || (!numbered && !(of.has("faces") && of.has("faceoffsets")))) continue;
    if (cells.face_locations.empty()) cells.face_locations.resize(cells.types.size(), cells::CellBlock::no_faces);
    if (numbered)
      add_numbered_faces(of);
    else
      add_lists(of);
  }
  if (cells.faces.empty()) cells.face_locations.clear();
}

}  // namespace tessera::io
