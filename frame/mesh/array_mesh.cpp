// SPDX-License-Identifier: BSD-3-Clause
#include "frame/mesh/array_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "cells/cell_block.hpp"
#include "cells/duplicate_cells.hpp"
#include "cells/mesh_assembly.hpp"
#include "scene/error.hpp"
#include "scene/number_type.hpp"

namespace tessera::frame {
namespace {

/// Calls `use` with the numbers in the type in which they are stored.
template <class Use>
auto with_numbers(const ArrayView& view, const Use& use) {
  return scene::with_number_type(view.type(), [&](auto zero) { return use(view.as<decltype(zero)>()); });
}

bool is_whole(NumberType type) { return type != NumberType::float32 && type != NumberType::float64; }

std::vector<double> doubles_of(const ArrayView& view) {
  return with_numbers(view, [](const auto& numbers) { return std::vector<double>(numbers.begin(), numbers.end()); });
}

/// Converts integers that must be in [least, end). Throws an error that names the first integer outside of this range.
template <class T>
std::vector<T> whole_numbers(const ArrayView& view, const char* name, std::uint64_t end, std::int64_t least = 0) {
  if (!is_whole(view.type()))
    throw scene::bad_input(fmt::format("mesh: {} are not whole numbers; give integers", name));
  return with_numbers(view, [&](const auto& numbers) {
    std::vector<T> values;
    values.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      // NOLINTNEXTLINE(bugprone-signed-char-misuse): numbers, not characters
      const auto number = static_cast<std::int64_t>(numbers[i]);
      if (number < least || number >= static_cast<std::int64_t>(end))
        throw scene::bad_input(fmt::format("mesh: {} {} is {}; it must be {} to {}", name, i, number, least,
                                           static_cast<std::int64_t>(end) - 1));
      values.push_back(static_cast<T>(number));
    }
    return values;
  });
}

void check_shapes(const MeshArrays& a) {
  if (a.points.size() % 3 != 0)
    throw scene::bad_input(fmt::format("mesh: {} coordinates are not three per point", a.points.size()));
  const std::size_t points = a.points.size() / 3;
  if (points > 0xffffffffull)
    throw scene::bad_input("mesh: more than 2^32 points are too many; give it in parts, one per rank");
  const bool as_tets = a.types.empty() && a.offsets.empty() && a.connectivity.empty();
  if (!as_tets && !a.tets.empty())
    throw scene::bad_input("mesh: cells are given twice; give tets, or types, offsets and connectivity");
  if (as_tets && a.tets.size() % 4 != 0)
    throw scene::bad_input(fmt::format("mesh: {} corners are not four per tet", a.tets.size()));
  if (!as_tets && a.offsets.size() != a.types.size() + 1)
    throw scene::bad_input(fmt::format("mesh: there are {} offsets for {} cells; give one offset more than cells",
                                       a.offsets.size(), a.types.size()));
  if (as_tets && !(a.faces.empty() && a.face_locations.empty()))
    throw scene::bad_input("mesh: faces are given for tets; give types, offsets and connectivity of polyhedra");
  if (a.faces.empty() ? !a.face_locations.empty() : a.face_locations.size() != a.types.size())
    throw scene::bad_input(fmt::format(
        "mesh: there are {} face locations for {} cells and {} numbers of faces; give one location per cell",
        a.face_locations.size(), a.types.size(), a.faces.size()));
  const std::size_t cells = as_tets ? a.tets.size() / 4 : a.types.size();
  if (!a.original_cells.empty() &&
      (a.original_cells.type() != NumberType::uint64 || a.original_cells.size() != cells || !as_tets))
    throw scene::bad_input(
        fmt::format("mesh: there are {} original cell numbers for {} cells; give tets, and one uint64 for each",
                    a.original_cells.size(), cells));
  const bool of_points = a.association == Association::point;
  const std::size_t wanted = of_points ? points : cells;
  if (a.scalars.size() != wanted)
    throw scene::bad_input(fmt::format("mesh: there are {} scalars for {} {}; give one for each", a.scalars.size(),
                                       wanted, of_points ? "points" : "cells"));
}

/// Returns the arrays without a copy if they have the layout that the renderer needs.
std::optional<scene::TetMeshView> borrowed(const MeshArrays& a) {
  if (a.points.type() != NumberType::float64 || a.scalars.type() != NumberType::float64 ||
      a.tets.type() != NumberType::uint32 || !a.types.empty())
    return std::nullopt;
  static_assert(sizeof(glm::dvec3) == 3 * sizeof(double) && sizeof(scene::Tet) == 4 * sizeof(std::uint32_t));
  scene::TetMeshView mesh;
  mesh.positions = {static_cast<const glm::dvec3*>(a.points.data()), a.points.size() / 3};
  mesh.tets = {static_cast<const scene::Tet*>(a.tets.data()), a.tets.size() / 4};
  mesh.scalars = a.scalars.as<double>();
  mesh.association = a.association;
  mesh.original_cell = a.original_cells.as<std::uint64_t>();
  for (const scene::Tet& tet : mesh.tets)
    for (const std::uint32_t v : tet)
      if (v >= mesh.positions.size()) return std::nullopt;  // reported by the conversion
  return mesh;
}

bool all_finite(const MeshArrays& a) {
  const auto finite = [](double v) { return std::isfinite(v); };
  return std::ranges::all_of(a.points.as<double>(), finite) && std::ranges::all_of(a.scalars.as<double>(), finite);
}

cells::CellBlock block_of(const MeshArrays& a) {
  cells::CellBlock block;
  const std::size_t points = a.points.size() / 3;
  const std::vector<double> coordinates = doubles_of(a.points);
  block.positions.resize(points);
  if (points > 0) std::memcpy(block.positions.data(), coordinates.data(), coordinates.size() * sizeof(double));
  if (a.types.empty()) {
    const auto corners = whole_numbers<std::uint32_t>(a.tets, "tet corner", points);
    block.tets.resize(corners.size() / 4);
    if (!corners.empty()) std::memcpy(block.tets.data(), corners.data(), corners.size() * sizeof(std::uint32_t));
  } else {
    block.types = whole_numbers<std::uint8_t>(a.types, "cell type", 256);
    block.connectivity = whole_numbers<std::uint32_t>(a.connectivity, "connectivity", points);
    block.offsets = whole_numbers<std::uint64_t>(a.offsets, "offset", a.connectivity.size() + 1);
    for (std::size_t i = 1; i < block.offsets.size(); ++i)
      if (block.offsets[i] < block.offsets[i - 1])
        throw scene::bad_input(fmt::format("mesh: offset {} is {}, below the one before it, {}", i, block.offsets[i],
                                           block.offsets[i - 1]));
    if (block.offsets.back() != block.connectivity.size() || block.offsets.front() != 0)
      throw scene::bad_input(
          fmt::format("mesh: offsets go from {} to {}; they must go from 0 to the length of the connectivity, {}",
                      block.offsets.front(), block.offsets.back(), block.connectivity.size()));
  }
  if (!a.faces.empty()) {
    block.faces = whole_numbers<std::uint32_t>(a.faces, "number of faces", 1ull << 32);
    block.face_locations = whole_numbers<std::int64_t>(a.face_locations, "face location", a.faces.size(), -1);
    cells::require_faces(block, "mesh");
  }
  block.fields.push_back(cells::field_of_values(a.field_name, "double", a.association, 1, doubles_of(a.scalars)));
  return block;
}

}  // namespace

ArrayMesh mesh_of_arrays(const MeshArrays& arrays, bool may_be_empty, const cells::HigherOrderPlanning& planning) {
  check_shapes(arrays);
  ReadOptions options;
  options.higher_order_tolerance = arrays.higher_order_tolerance;
  options.higher_order_tets = arrays.higher_order_tets;
  if (may_be_empty && arrays.tets.empty() && arrays.types.empty()) {
    scene::TetMeshView nothing;
    nothing.association = arrays.association;
    planning({}, options, {}, {});
    return {nothing, nullptr, {}, {}, {}};
  }
  ArrayMesh result;
  if (const auto mesh = borrowed(arrays); mesh && !mesh->tets.empty() && all_finite(arrays)) {
    planning({}, options, {}, {});
    result.mesh = *mesh;
    result.owner = arrays.owner;
    result.counts.cells_read = result.counts.tets_made = mesh->tets.size();
    result.counts.points_read = mesh->positions.size();
    if (!may_be_empty) result.counts.cells_duplicate = cells::count_duplicate_cells(*mesh);
    return result;
  }
  std::vector<cells::CellBlock> blocks;
  blocks.push_back(block_of(arrays));
  auto file = std::make_shared<cells::MeshFile>(cells::assemble_mesh(std::move(blocks), options, "mesh", planning));
  result.mesh = file->mesh;
  result.counts = file->counts;
  result.higher_order = file->higher_order;
  result.notes = file->notes;
  result.owner = std::move(file);
  return result;
}

ArrayMesh mesh_to_write(const MeshArrays& arrays) {
  check_shapes(arrays);
  ArrayMesh result;
  if (const auto mesh = borrowed(arrays); mesh && !mesh->tets.empty())
    result.mesh = *mesh;
  else
    result = mesh_of_arrays(arrays, false);
  result.mesh.field_name = arrays.field_name;
  return result;
}

MeshArrays arrays_of(const scene::TetMeshView& mesh, std::string field_name, std::shared_ptr<const void> owner) {
  MeshArrays arrays;
  arrays.points = ArrayView(mesh.positions);
  arrays.tets = ArrayView(mesh.tets.data(), 4 * mesh.tets.size(), NumberType::uint32);
  arrays.scalars = ArrayView(mesh.scalars);
  arrays.association = mesh.association;
  arrays.field_name = std::move(field_name);
  arrays.original_cells = ArrayView(mesh.original_cell);
  arrays.owner = std::move(owner);
  return arrays;
}

}  // namespace tessera::frame
