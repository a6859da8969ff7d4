// SPDX-License-Identifier: BSD-3-Clause
#include "io/foreign/client/foreign_surfaces.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/foreign/client/foreign_numbers.hpp"

namespace tessera::io {
namespace {

std::vector<double> component_of(const ForeignFile& file, const ForeignArray& array, std::span<const std::byte> bytes,
                                 int component) {
  std::vector<double> values(array.tuples);
  if (bytes.size() < array.bytes()) refuse_surface(file.source);
  read_tuples(bytes, array.type, array.components, component, 0, values);
  return values;
}

void add_points(const ForeignFile& file, const ForeignArray& points, cells::Surface& surface) {
  if (points.components != 3) refuse_surface(file.source);
  const std::vector<std::byte> bytes = file.arrays->copy(points, file.source);
  surface.points.resize(points.tuples);
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double> values = component_of(file, points, bytes, axis);
    for (std::size_t v = 0; v < values.size(); ++v) surface.points[v][axis] = values[v];
  }
}

/// Reads offsets, which may be 32 or 64 bits wide.
std::vector<std::int64_t> offsets_of(const ForeignFile& file, const ForeignArray& array) {
  if (array.type == NumberType::int64) return numbers_of<std::int64_t>(file, array);
  if (array.type != NumberType::int32) refuse_surface(file.source);
  const auto narrow = numbers_of<std::int32_t>(file, array);
  return {narrow.begin(), narrow.end()};
}

cells::Surface surface_of(const ForeignFile& file, const ForeignPart& part) {
  cells::Surface surface;
  if (!part.points || !part.offsets || !part.connectivity) return surface;
  if (part.connectivity->type != NumberType::uint32) refuse_surface(file.source);
  add_points(file, *part.points, surface);
  const std::vector<std::int64_t> offsets = offsets_of(file, *part.offsets);
  const auto corners = numbers_of<std::uint32_t>(file, *part.connectivity);
  for (std::size_t c = 0; c + 1 < offsets.size(); ++c) {
    if (offsets[c] < 0 || offsets[c + 1] < offsets[c] || static_cast<std::uint64_t>(offsets[c + 1]) > corners.size())
      refuse_surface(file.source);
    cells::Polygon polygon;
    for (auto k = static_cast<std::size_t>(offsets[c]); k < static_cast<std::size_t>(offsets[c + 1]); ++k) {
      if (corners[k] >= surface.points.size())
        throw scene::bad_input(
            fmt::format("{}: face {} uses point {}, but the file has only {} points; write the file again", file.source,
                        c, corners[k], surface.points.size()));
      polygon.push_back(corners[k]);
    }
    surface.facets.push_back({{std::move(polygon)}, {}});
  }
  return surface;
}

ForeignFile open_surface(const InputFile& file, const char* reader) {
  ForeignFile opened = open_foreign(file, {{"reader", reader}});
  if (opened.contents.parts.size() != 1 || opened.contents.parts.front().kind != ForeignPart::Kind::surface)
    refuse_surface(opened.source);
  return opened;
}

}  // namespace

cells::Surface read_stl(const InputFile& file) {
  const ForeignFile opened = open_surface(file, "stl");
  return surface_of(opened, opened.contents.parts.front());
}

VtkSurface read_vtk_surface(const InputFile& file) {
  const ForeignFile opened = open_surface(file, "vtk_surface");
  const ForeignPart& part = opened.contents.parts.front();
  VtkSurface result;
  result.notes = opened.contents.notes;
  result.surface = surface_of(opened, part);
  std::size_t left_out = 0;
  for (const ForeignArray& array : part.point_fields) {
    if (array.components != 1 || array.tuples != result.surface.points.size()) {
      ++left_out;
      continue;
    }
    result.attribute_names.push_back(array.name);
    result.surface.attributes.push_back(component_of(opened, array, opened.arrays->copy(array, opened.source), 0));
  }
  left_out += part.cell_fields.size();
  if (left_out > 0)
    result.notes.push_back(fmt::format(
        "{} left out: only arrays with one number per point become fields",
        left_out == 1 ? "1 array of the surface is" : fmt::format("{} arrays of the surface are", left_out)));
  return result;
}

}  // namespace tessera::io
