// SPDX-License-Identifier: BSD-3-Clause
#include "cells/cell_block.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "cells/tuple_length.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {

BlockField field_of_values(std::string name, std::string type, scene::Association association, int components,
                           std::vector<double> values) {
  BlockField field;
  field.name = std::move(name);
  field.type = std::move(type);
  field.association = association;
  field.components = components;
  field.tuples = values.size() / static_cast<std::size_t>(components);
  const auto owned = std::make_shared<const std::vector<double>>(std::move(values));
  field.read = [owned, components](int component, std::size_t first, std::span<double> out) {
    const double* tuple = owned->data() + first * static_cast<std::size_t>(components);
    for (double& value : out) {
      value = component == magnitude ? tuple_length(tuple, components) : tuple[component];
      tuple += components;
    }
  };
  return field;
}

void require_faces(const CellBlock& block, const std::string& where) {
  constexpr std::uint8_t polyhedron = vtk_number(CellType::polyhedron);
  if (block.face_locations.empty() && block.faces.empty()) return;
  if (block.face_locations.size() != block.types.size())
    throw scene::bad_input(fmt::format("{}: it has {} face locations for {} cells; write one for each cell", where,
                                       block.face_locations.size(), block.types.size()));
  const std::size_t numbers = block.faces.size(), points = block.positions.size();
  std::size_t used = 0;
  for (std::size_t c = 0; c < block.types.size(); ++c) {
    if (block.types[c] != polyhedron || block.face_locations[c] == CellBlock::no_faces) continue;
    const auto first = static_cast<std::uint64_t>(block.face_locations[c]);
    const auto refuse = [&](const std::string& what) {
      return scene::bad_input(
          fmt::format("{}: cell {} is a polyhedron {}; the faces are damaged, write them again", where, c, what));
    };
    if (first >= numbers)
      throw refuse(fmt::format("whose faces begin at number {}, but there are only {} numbers", block.face_locations[c],
                               numbers));
    std::size_t at = first + 1;
    for (std::uint32_t left = block.faces[first]; left > 0; --left) {
      if (at >= numbers || block.faces[at] >= numbers - at)
        throw refuse(fmt::format("with {} faces, whose lists end after the last of the {} numbers", block.faces[first],
                                 numbers));
      const std::size_t end = at + 1 + block.faces[at];
      for (++at; at < end; ++at)
        if (block.faces[at] >= points)
          throw refuse(fmt::format("with point {} in a face, but there are only {} points", block.faces[at], points));
    }
    used += at - first;
    if (used > numbers) throw refuse("that has faces of another cell");
  }
}

}  // namespace tessera::cells
