// SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/vtk_xml_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/vtk/vtk_xml_whole.hpp"
#include "io/vtk/vtu_cells.hpp"
#include "scene/error.hpp"

namespace tessera::io {
namespace {

/// The points array of a piece. Throws Error(bad_input) if it is missing.
const VtkXmlArray& points_of(const VtkXmlOpened& of, std::size_t piece) {
  const auto& arrays = of.grid.pieces[piece].coordinates;
  if (arrays.size() != 1 || !arrays[0].type)
    throw scene::bad_input(
        fmt::format("{}: piece {} of it has {} arrays of points, not one; the file is damaged, "
                    "export it again",
                    of.source, piece, arrays.size()));
  return arrays[0];
}

/// Throws if `bytes` of coordinates or corners cannot come from a file of this size, before memory is allocated. The
/// coordinates and corners of real meshes compress by a factor of 2 to 50.
void require_proportion(const VtkXmlOpened& of, std::uint64_t bytes, const char* what) {
  constexpr std::uint64_t always = 64 << 20, times = 128;
  if (const std::uint64_t size = of.file->size(); bytes > always && (bytes - always) / times > size)
    throw scene::bad_input(fmt::format(
        "{}: its {} are {} MiB, which is implausible for a file of {} bytes; export it again, without compression",
        of.source, what, bytes >> 20, size));
}

/// Adds the points of all pieces; no value if there are none or their types differ.
std::optional<ForeignArray> hold_points(const VtkXmlOpened& of, bool& agree) {
  VtkXmlWhole whole;
  for (std::size_t p = 0; p < of.grid.pieces.size(); ++p) {
    const std::uint64_t points = of.grid.pieces[p].points;
    if (points == 0) continue;
    const VtkXmlArray& array = points_of(of, p);
    agree = agree && (whole.segments.empty() || (array.type == whole.segments[0].array.type &&
                                                 array.components == whole.segments[0].array.components));
    whole.components = array.components;
    whole.segments.push_back({array, points * static_cast<std::uint64_t>(array.components)});
  }
  if (whole.segments.empty() || !agree) return std::nullopt;
  const NumberType type = *whole.segments[0].array.type;
  std::uint64_t numbers = 0;
  for (const VtkXmlSegment& segment : whole.segments) numbers += segment.numbers;
  require_proportion(of, numbers * size_of(type), "points");
  return hold_whole(of, std::move(whole), {.type = type});
}

/// Adds the point indices of cells; for tets, one tuple per cell.
ForeignArray hold_connectivity(const VtkXmlOpened& of, VtuCells& cells) {
  ForeignArray as{.type = NumberType::uint32, .components = cells.are_tets ? 4 : 1};
  if (!cells.connectivity.empty()) return of.arrays->hold_vector(std::move(as), std::move(cells.connectivity));
  struct Uses {
    VtkXmlSegment segment;
    std::uint64_t first_point;
  };
  std::vector<Uses> uses;
  std::uint64_t first_point = 0;
  for (std::size_t p = 0; p < of.grid.pieces.size(); first_point += of.grid.pieces[p++].points)
    if (cells.uses[p] > 0)
      uses.push_back({{topology_of(of.grid, p, "connectivity", of.source), cells.uses[p]}, first_point});
  require_proportion(of, cells.offsets.back() * sizeof(std::uint32_t), "cells' corners");
  as.tuples = cells.offsets.back() / static_cast<std::uint64_t>(as.components);
  return of.arrays->hold(std::move(as), [file = of.file, uses, source = of.source](const system::ByteSink& use) {
    std::vector<std::uint32_t> narrow;
    for (const Uses& piece : uses)
      stream_whole_numbers(*file, piece.segment, 4, source, [&](std::span<const std::int64_t> points) {
        narrow.resize(points.size());
        for (std::size_t k = 0; k < points.size(); ++k) narrow[k] = point_number(points[k], piece.first_point);
        use(std::as_bytes(std::span(narrow)));
      });
  });
}

void hold_cells(const VtkXmlOpened& of, ForeignPart& part) {
  std::uint64_t count = 0;
  for (const VtkXmlPiece& piece : of.grid.pieces) count += piece.cells;
  constexpr std::uint64_t type_and_offset = 9;
  require_proportion(of, count * type_and_offset, "cells");
  VtuCells cells = read_vtu_cells(*of.file, of.grid, of.source);
  part.connectivity = hold_connectivity(of, cells);
  if (cells.are_tets) return;
  part.types = of.arrays->hold_vector({.type = NumberType::uint8}, std::move(cells.types));
  part.offsets = of.arrays->hold_vector({.type = NumberType::uint64}, std::move(cells.offsets));
  if (cells.faces.empty()) return;
  part.faces = of.arrays->hold_vector({.type = NumberType::uint32}, std::move(cells.faces));
  part.face_locations = of.arrays->hold_vector({.type = NumberType::int64}, std::move(cells.face_locations));
}

/// Parses exactly as many numbers as `numbers` has, separated by blanks. Returns false for any other text.
template <class Numbers>
bool read_numbers(const std::string& text, Numbers& numbers) {
  const char *at = text.data(), *const end = at + text.size();
  const auto skip = [&] {
    while (at < end && (*at == ' ' || (*at >= '\t' && *at <= '\r'))) ++at;
  };
  for (auto& number : numbers) {
    skip();
    const auto [behind, error] = std::from_chars(at, end, number);
    if (error != std::errc()) return false;
    at = behind;
  }
  skip();
  return at == end;
}

/// Sets the attributes of a grid of cells. Returns false if this reader does not support the grid.
bool set_grid(VtkXmlGrid& grid, ForeignPart& part) {
  constexpr std::int64_t most = 1 << 20;  // limit, so that point counts do not overflow
  std::array<std::int64_t, 6> extent{};
  VtkXmlPiece& piece = grid.pieces.front();
  if (grid.pieces.size() != 1 || !read_numbers(grid.element.word("WholeExtent"), part.extent) ||
      !read_numbers(piece.extent, extent) || extent != part.extent)
    return false;
  piece.points = piece.cells = 1;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t low = extent[2 * a], high = extent[2 * a + 1];
    if (low < -most || high > most || high <= low) return false;
    piece.points *= static_cast<std::uint64_t>(high - low + 1);
    piece.cells *= static_cast<std::uint64_t>(high - low);
  }
  // Without fields, a grid of any size has a file of a few bytes, so the size of the file would not limit the grid.
  if (piece.point_fields.arrays.empty() && piece.cell_fields.arrays.empty()) return false;
  if (grid.element.name != "ImageData") return true;
  part.kind = ForeignPart::Kind::image;
  return read_numbers(grid.element.word("Origin", "0 0 0"), part.origin) &&
         read_numbers(grid.element.word("Spacing", "1 1 1"), part.spacing) &&
         read_numbers(grid.element.word("Direction", "1 0 0 0 1 0 0 0 1"), part.direction);
}

bool hold_axes(const VtkXmlOpened& of, ForeignPart& part) {
  part.kind = ForeignPart::Kind::rectilinear;
  const auto& arrays = of.grid.pieces.front().coordinates;
  if (arrays.size() != 3) return false;
  for (std::size_t a = 0; a < 3; ++a) {
    if (!arrays[a].type || arrays[a].components != 1) return false;
    const auto points = static_cast<std::uint64_t>(part.extent[2 * a + 1] - part.extent[2 * a] + 1);
    part.coordinates.push_back(hold_whole(of, {{{arrays[a], points}}}, {.type = *arrays[a].type}));
  }
  return true;
}

/// Sets the points and cells of the data set. Returns false if this reader does not support them.
bool set_part(const VtkXmlOpened& of, ForeignPart& part) {
  const std::string& kind = of.grid.element.name;
  bool agree = true;
  if (kind == "ImageData") return true;
  if (kind == "RectilinearGrid") return hold_axes(of, part);
  if (kind == "StructuredGrid") part.kind = ForeignPart::Kind::structured;
  part.points = hold_points(of, agree);
  if (agree && kind == "UnstructuredGrid") hold_cells(of, part);
  return agree;
}

void require_end(const system::PositionalFile& file, const std::string& source) {
  std::string end(std::min<std::uint64_t>(file.size(), 1024), '\0');
  file.read(file.size() - end.size(), reinterpret_cast<std::byte*>(end.data()), end.size());
  if (end.find("</VTKFile") == std::string::npos)
    throw scene::bad_input(
        fmt::format("{}: it does not end with </VTKFile>; the file is truncated or damaged, export it again", source));
}

}  // namespace

std::optional<ForeignFile> open_vtk_xml(const std::filesystem::path& path, const ReadProgressFunction& progress) {
  constexpr std::array known = {"UnstructuredGrid", "StructuredGrid", "RectilinearGrid", "ImageData"};
  const std::string source = path.string();
  const auto file = std::make_shared<const system::PositionalFile>(path);
  require_end(*file, source);
  std::optional<VtkXmlGrid> grid = read_vtk_xml_grid(*file, source);
  if (!grid || std::ranges::count(known, grid->element.name) == 0) return std::nullopt;
  ForeignPart part;
  if (grid->element.name != "UnstructuredGrid" && !set_grid(*grid, part)) return std::nullopt;
  if (!fields_agree(*grid, fields_of_points) || !fields_agree(*grid, fields_of_cells)) return std::nullopt;
  const VtkXmlOpened of{file, *grid, source, std::make_shared<VtkXmlArrays>(progress)};
  if (!set_part(of, part)) return std::nullopt;
  part.point_fields = hold_fields(of, fields_of_points);
  part.cell_fields = hold_fields(of, fields_of_cells);
  ForeignFile opened;
  opened.source = source;
  opened.arrays = of.arrays;
  opened.contents.parts.push_back(std::move(part));
  opened.contents.block_names.emplace_back();
  return opened;
}

}  // namespace tessera::io
