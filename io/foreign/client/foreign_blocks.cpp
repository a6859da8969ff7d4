// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <mutex>

#include "cells/block_choice.hpp"
#include "cells/ghost_bits.hpp"
#include "io/foreign/client/foreign_file.hpp"
#include "scene/error.hpp"
#include "system/large_vector.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::io {
namespace {

using scene::Association;

/// The numbers of a field. The source holds the numbers until they are first read; afterwards this object holds them.
class FetchedArray {
 public:
  FetchedArray(const ForeignFile& file, ForeignArray array)
      : arrays_(file.arrays), source_(file.source), array_(std::move(array)) {}
  ~FetchedArray() {
    if (!fetched_) arrays_->drop(std::span(&array_.number, 1));
  }
  FetchedArray(const FetchedArray&) = delete;
  FetchedArray& operator=(const FetchedArray&) = delete;

  void read(int component, std::size_t first, std::span<double> out) {
    std::call_once(once_, [&] {
      bytes_ = arrays_->copy(array_, source_);
      fetched_ = true;
    });
    read_tuples(bytes_, array_.type, array_.components, component, first, out);
  }

 private:
  std::shared_ptr<ArraySource> arrays_;
  std::string source_;
  ForeignArray array_;
  std::once_flag once_;
  std::vector<std::byte> bytes_;
  bool fetched_ = false;
};

template <class T>
std::span<const T> numbers_in(std::span<const std::byte> bytes) {
  return {reinterpret_cast<const T*>(bytes.data()), bytes.size() / sizeof(T)};
}

void copy_points(const ForeignFile& file, const ForeignArray& points, cells::CellBlock& block,
                 const std::string& where) {
  if (points.components != 3)
    throw scene::bad_input(fmt::format("{}: its points have {} coordinates; give x y z", where, points.components));
  system::reserve_large(block.positions, points.tuples);
  with_number_type(points.type, [&](auto zero) {
    using Number = decltype(zero);
    file.arrays->stream(points, where, [&](std::span<const std::byte> tuples) {
      const auto p = numbers_in<Number>(tuples);
      for (std::size_t k = 0; k + 2 < p.size(); k += 3)
        block.positions.emplace_back(static_cast<double>(p[k]), static_cast<double>(p[k + 1]),
                                     static_cast<double>(p[k + 2]));
    });
  });
}

[[noreturn]] void refuse_corner(std::size_t cell, std::uint32_t corner, std::size_t points, const std::string& where) {
  throw scene::bad_input(fmt::format(
      "{}: cell {} uses {}, but the file has only {} points; write cells and points from one mesh", where, cell,
      corner == UINT32_MAX ? "a point with an impossible number" : fmt::format("point {}", corner), points));
}

/// Checks offsets and corners received from a reader.
void check_cells(cells::CellBlock& block, const std::string& where) {
  const std::size_t cells = block.types.size();
  const auto& offsets = block.offsets;
  if (offsets.size() != cells + 1 || offsets[0] != 0 || offsets[cells] > block.connectivity.size())
    throw scene::bad_input(
        fmt::format("{}: cell offsets do not fit the {} cells and {} connectivity entries; the file "
                    "is damaged, write it again",
                    where, cells, block.connectivity.size()));
  for (std::size_t c = 0; c < cells; ++c)
    if (static_cast<std::int64_t>(offsets[c + 1]) < static_cast<std::int64_t>(offsets[c]))
      throw scene::bad_input(
          fmt::format("{}: the offset of cell {} is {}, less than the one before, {}; the file is "
                      "damaged, write it again",
                      where, c, static_cast<std::int64_t>(offsets[c + 1]), static_cast<std::int64_t>(offsets[c])));
  block.connectivity.resize(offsets[cells]);
  const std::size_t points = block.positions.size();
  for (std::size_t k = 0; k < block.connectivity.size(); ++k)
    if (block.connectivity[k] >= points) {
      const auto cell = std::upper_bound(offsets.begin(), offsets.end(), k) - offsets.begin() - 1;
      refuse_corner(static_cast<std::size_t>(cell), block.connectivity[k], points, where);
    }
}

void check_tets(std::span<const scene::Tet> tets, std::size_t points, const std::string& where) {
  std::uint32_t largest = 0;
  for (const scene::Tet& tet : tets) largest = std::max({largest, tet[0], tet[1], tet[2], tet[3]});
  for (std::size_t t = 0; t < tets.size() && largest >= points; ++t)
    for (const std::uint32_t corner : tets[t])
      if (corner >= points) refuse_corner(t, corner, points, where);
}

/// Reads all values of an array that are stored as `Stored`, and converts them to T.
template <class Stored, class T>
void copy_numbers(const ForeignFile& file, const ForeignArray& array, std::vector<T>& to, const std::string& where) {
  system::reserve_large(to, array.bytes() / sizeof(Stored));
  file.arrays->stream(array, where, [&](std::span<const std::byte> tuples) {
    const auto numbers = numbers_in<Stored>(tuples);
    to.insert(to.end(), numbers.begin(), numbers.end());
  });
}

void copy_offsets(const ForeignFile& file, const ForeignArray& offsets, cells::CellBlock& block,
                  const std::string& where) {
  switch (offsets.type) {
    case NumberType::int64:
      return copy_numbers<std::int64_t>(file, offsets, block.offsets, where);
    case NumberType::uint64:
      return copy_numbers<std::uint64_t>(file, offsets, block.offsets, where);
    case NumberType::int32:
      return copy_numbers<std::int32_t>(file, offsets, block.offsets, where);
    default:
      throw scene::bad_input(
          fmt::format("{}: its cells have an unsupported integer size; write the file again", where));
  }
}

void add_unstructured_cells(const ForeignFile& file, const ForeignPart& part, cells::CellBlock& block,
                            const std::string& where) {
  if (!part.connectivity) return;
  if (part.connectivity->type != NumberType::uint32)
    throw scene::bad_input(fmt::format("{}: its cells have an unsupported integer size; write the file again", where));
  if (!part.types && part.connectivity->components == 4) {
    copy_numbers<scene::Tet>(file, *part.connectivity, block.tets, where);
    return check_tets(block.tets, block.positions.size(), where);
  }
  if (!part.types || !part.offsets || part.types->type != NumberType::uint8 ||
      part.types->tuples + 1 != part.offsets->tuples)
    throw scene::bad_input(fmt::format("{}: {} cell types for {} cells; the file is damaged, write it again", where,
                                       part.types ? part.types->tuples : 0,
                                       part.offsets && part.offsets->tuples > 0 ? part.offsets->tuples - 1 : 0));
  copy_numbers<std::uint8_t>(file, *part.types, block.types, where);
  copy_offsets(file, *part.offsets, block, where);
  copy_numbers<std::uint32_t>(file, *part.connectivity, block.connectivity, where);
  check_cells(block, where);
  if (part.faces && part.face_locations) {
    if (part.faces->type != NumberType::uint32 || part.face_locations->type != NumberType::int64)
      throw scene::bad_input(
          fmt::format("{}: its faces have an unsupported integer size; write the file again", where));
    copy_numbers<std::uint32_t>(file, *part.faces, block.faces, where);
    copy_numbers<std::int64_t>(file, *part.face_locations, block.face_locations, where);
    cells::require_faces(block, where);
  }
  // Blocks of tets alone are stored without types. Most readers send them in this form; the Exodus reader sends types.
  const bool all_tets = std::all_of(block.types.begin(), block.types.end(),
                                    [](std::uint8_t t) { return t == vtk_number(CellType::tetra); });
  for (std::size_t c = 0; all_tets && c < block.types.size(); ++c)
    if (block.offsets[c] != 4 * c) return;
  if (!all_tets || block.types.empty() || block.connectivity.size() != 4 * block.types.size()) return;
  block.tets.resize(block.types.size());
  std::memcpy(block.tets.data(), block.connectivity.data(), block.connectivity.size() * sizeof(std::uint32_t));
  block.types = {}, block.offsets = {}, block.connectivity = {};
}

/// Adds the hexahedra between n[0] x n[1] x n[2] points. A flat grid has only faces or lines, which are counted and
/// skipped.
void add_grid_cells(const std::array<std::int64_t, 3>& n, cells::CellBlock& block, const std::string& where) {
  std::uint64_t points = 1;
  for (const std::int64_t side : n)
    if (__builtin_mul_overflow(points, static_cast<std::uint64_t>(std::max<std::int64_t>(side, 0)), &points))
      points = std::numeric_limits<std::uint64_t>::max();
  if (points != block.positions.size())
    throw scene::bad_input(fmt::format("{}: its header states {} x {} x {} points, but it has {}; the file is damaged",
                                       where, n[0], n[1], n[2], block.positions.size()));
  if (points == 0) return;
  if (points > std::numeric_limits<std::uint32_t>::max())
    throw scene::bad_input(fmt::format(
        "{}: {} points in one block are too many; split it into blocks of fewer than 2^32 points", where, points));
  std::size_t cells = 1;
  for (const std::int64_t side : n) cells *= static_cast<std::size_t>(std::max<std::int64_t>(side - 1, 1));
  if (n[0] < 2 || n[1] < 2 || n[2] < 2) {
    block.types.assign(cells, vtk_number(CellType::quad));
    block.offsets.assign(cells + 1, 0);
    return;
  }
  block.types.assign(cells, vtk_number(CellType::hexahedron));
  block.offsets.resize(cells + 1);
  for (std::size_t c = 0; c <= cells; ++c) block.offsets[c] = 8 * c;
  block.connectivity.reserve(8 * cells);
  const auto row = static_cast<std::uint32_t>(n[0]), slice = row * static_cast<std::uint32_t>(n[1]);
  for (std::uint32_t k = 0; k + 1 < n[2]; ++k)
    for (std::uint32_t j = 0; j + 1 < n[1]; ++j)
      for (std::uint32_t i = 0; i + 1 < n[0]; ++i) {
        const std::uint32_t v = i + row * j + slice * k;
        const std::uint32_t corner[8] = {v,         v + 1,         v + 1 + row,         v + row,
                                         v + slice, v + 1 + slice, v + 1 + row + slice, v + row + slice};
        block.connectivity.insert(block.connectivity.end(), corner, corner + 8);
      }
}

std::array<std::int64_t, 3> points_along(const ForeignPart& part) {
  std::array<std::int64_t, 3> n{};
  for (std::size_t a = 0; a < 3; ++a) n[a] = part.extent[2 * a + 1] - part.extent[2 * a] + 1;
  return n;
}

void add_rectilinear_points(const ForeignFile& file, const ForeignPart& part, cells::CellBlock& block,
                            const std::string& where) {
  std::array<std::vector<double>, 3> axis;
  for (std::size_t a = 0; a < 3 && a < part.coordinates.size(); ++a) {
    const ForeignArray& array = part.coordinates[a];
    axis[a].resize(array.tuples);
    read_tuples(file.arrays->copy(array, where), array.type, array.components, 0, 0, axis[a]);
  }
  const auto n = points_along(part);
  for (std::size_t a = 0; a < 3; ++a)
    if (static_cast<std::int64_t>(axis[a].size()) != n[a])
      throw scene::bad_input(fmt::format("{}: {} x {} x {} coordinates for {} x {} x {} points; the file is damaged",
                                         where, axis[0].size(), axis[1].size(), axis[2].size(), n[0], n[1], n[2]));
  block.positions.reserve(axis[0].size() * axis[1].size() * axis[2].size());
  for (const double c : axis[2])
    for (const double b : axis[1])
      for (const double a : axis[0]) block.positions.emplace_back(a, b, c);
}

void add_image_points(const ForeignPart& image, cells::CellBlock& block) {
  const auto& d = image.direction;
  for (std::int64_t k = image.extent[4]; k <= image.extent[5]; ++k)
    for (std::int64_t j = image.extent[2]; j <= image.extent[3]; ++j)
      for (std::int64_t i = image.extent[0]; i <= image.extent[1]; ++i) {
        const double x = image.spacing[0] * static_cast<double>(i), y = image.spacing[1] * static_cast<double>(j),
                     z = image.spacing[2] * static_cast<double>(k);
        block.positions.emplace_back(image.origin[0] + d[0] * x + d[1] * y + d[2] * z,
                                     image.origin[1] + d[3] * x + d[4] * y + d[5] * z,
                                     image.origin[2] + d[6] * x + d[7] * y + d[8] * z);
      }
}

void add_polygons(const ForeignFile& file, const ForeignPart& part, cells::CellBlock& block, const std::string& where) {
  if (part.points) copy_points(file, *part.points, block, where);
  if (!part.offsets || !part.connectivity || part.offsets->tuples == 0) return;
  if (part.connectivity->type != NumberType::uint32)
    throw scene::bad_input(fmt::format("{}: its cells have an unsupported integer size; write the file again", where));
  block.types.assign(part.offsets->tuples - 1, vtk_number(CellType::polygon));
  copy_offsets(file, *part.offsets, block, where);
  copy_numbers<std::uint32_t>(file, *part.connectivity, block.connectivity, where);
  check_cells(block, where);
}

cells::CellBlock block_of(const ForeignFile& file, const ForeignPart& part, GridsAre grids) {
  cells::CellBlock block;
  block.name = part.name;
  const std::string where = part.name.empty() ? file.source : fmt::format("{}: block '{}'", file.source, part.name);
  switch (part.kind) {
    case ForeignPart::Kind::unstructured:
      if (part.points) copy_points(file, *part.points, block, where);
      add_unstructured_cells(file, part, block, where);
      break;
    case ForeignPart::Kind::structured:
      if (part.points) copy_points(file, *part.points, block, where);
      add_grid_cells(points_along(part), block, where);
      break;
    case ForeignPart::Kind::rectilinear:
      add_rectilinear_points(file, part, block, where);
      add_grid_cells(points_along(part), block, where);
      break;
    case ForeignPart::Kind::image:
      if (grids == GridsAre::volumes)
        throw scene::bad_input(
            fmt::format("{}: it is a regular grid (image data), not a mesh; give it alone or among volumes", where));
      add_image_points(part, block);
      add_grid_cells(points_along(part), block, where);
      break;
    case ForeignPart::Kind::trees:
      throw scene::bad_input(
          fmt::format("{}: it is a hyper tree grid, which cannot be combined with other files; give it alone", where));
    case ForeignPart::Kind::surface:
      if (file.with_surfaces) {
        add_polygons(file, part, block, where);
        break;
      }
      throw scene::bad_input(fmt::format("{}: it holds a surface without volume cells; give a mesh", where));
  }
  block.point_ghost = ghost_bits(file, part.point_fields, block.positions.size());
  block.cell_ghost = ghost_bits(file, part.cell_fields, block.cell_count());
  add_foreign_fields(file, part, Association::point, block.positions.size(), block, where);
  // In VTK, the cell data of a surface contain the values of points and lines before those of polygons.
  if (part.kind != ForeignPart::Kind::surface ||
      std::ranges::all_of(part.cell_fields, [&](const ForeignArray& a) { return a.tuples == block.cell_count(); }))
    add_foreign_fields(file, part, Association::cell, block.cell_count(), block, where);
  return block;
}

}  // namespace

cells::BlockField foreign_field(const ForeignFile& file, const ForeignArray& array, Association association) {
  cells::BlockField field;
  field.name = array.name;
  field.association = association;
  field.components = array.components;
  field.type = scene::listed_name(array.type);
  field.tuples = array.tuples;
  field.active = array.active;
  field.ids = array.ids;
  field.tally = array.tally;
  field.read = [fetched = std::make_shared<FetchedArray>(file, array)](
                   int component, std::size_t first, std::span<double> out) { fetched->read(component, first, out); };
  return field;
}

void add_foreign_fields(const ForeignFile& file, const ForeignPart& part, Association association, std::size_t expected,
                        cells::CellBlock& block, const std::string& where) {
  const bool point = association == Association::point;
  for (const ForeignArray& array : point ? part.point_fields : part.cell_fields) {
    if (array.tuples != expected)
      throw scene::bad_input(fmt::format("{}: field '{}' has {} values for {} {}s; write the file again", where,
                                         array.name, array.tuples, expected, point ? "point" : "cell"));
    block.fields.push_back(foreign_field(file, array, association));
  }
}

std::vector<std::uint8_t> ghost_bits(const ForeignFile& file, const std::vector<ForeignArray>& fields, std::size_t n) {
  const auto read = [&](const char* name) {
    std::vector<std::uint8_t> bits;
    const auto array =
        std::find_if(fields.begin(), fields.end(), [&](const ForeignArray& a) { return a.name == name; });
    if (array == fields.end() || array->components != 1 || array->tuples != n) return bits;
    std::vector<double> values(n);
    read_tuples(file.arrays->copy(*array, file.source, ArraySource::Then::kept), array->type, 1, 0, 0, values);
    for (const double value : values)
      bits.push_back(value >= 0 && value < 256 ? static_cast<std::uint8_t>(value) : std::uint8_t{0});
    return bits;
  };
  std::vector<std::uint8_t> bits = read("vtkGhostType");
  if (bits.empty()) {
    bits = read("vtkGhostLevels");
    for (std::uint8_t& level : bits) level = level > 0 ? cells::duplicate_cell : 0;
  }
  return bits;
}

std::vector<cells::CellBlock> blocks_of(const ForeignFile& file, std::vector<std::string>& notes, GridsAre grids) {
  std::uint64_t bytes = 0;
  for (const ForeignPart& part : file.contents.parts)
    for (const auto* array : {&part.points, &part.types, &part.offsets, &part.connectivity})
      if (*array) bytes += (*array)->bytes();
  file.arrays->expect(bytes);
  std::vector<cells::CellBlock> blocks;
  std::vector<std::string> surfaces;
  for (const ForeignPart& part : file.contents.parts) {
    if (part.kind == ForeignPart::Kind::surface && file.contents.parts.size() > 1 && !file.with_surfaces) {
      surfaces.push_back(part.name);
      continue;
    }
    blocks.push_back(block_of(file, part, grids));
  }
  if (!surfaces.empty()) notes.push_back(cells::note_on_surfaces("block", surfaces));
  return blocks;
}

cells::MeshBlocks mesh_of(const ForeignFile& file, GridsAre grids) {
  const ForeignContents& contents = file.contents;
  cells::MeshBlocks result{{}, contents.notes, contents.format, contents.block_names, contents.surface_names};
  result.time_step = contents.time_step;
  result.xy_in_degrees = contents.xy_in_degrees;
  result.blocks = blocks_of(file, result.notes, grids);
  return result;
}

}  // namespace tessera::io
