// SPDX-License-Identifier: BSD-3-Clause
#include "readers/vtk/exodus_sets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "readers/vtk/exodus_elements.hpp"
#include "scene/error.hpp"
#include "tessera/cell_type.hpp"
#include "tessera/program/text.hpp"

namespace tessera::readers {
namespace {

std::vector<std::int64_t> ids_of(int file, ex_entity_type type, std::int64_t count, std::uint64_t most_values,
                                 const std::function<void(const std::string&)>& fail) {
  if (count < 0 || static_cast<std::uint64_t>(count) > most_values) fail(fmt::format("it states {} sets", count));
  std::vector<std::int64_t> ids(static_cast<std::size_t>(count));
  if (!ids.empty() && ex_get_ids(file, type, ids.data()) < 0) fail("the sets cannot be read");
  return ids;
}

/// Throws for a choice that selects one of these sets.
void refuse(int file, ex_entity_type type, const std::vector<std::int64_t>& ids, const char* what, const char* holds,
            const cells::BlockChoice& choice, const std::string& source) {
  if (choice.empty()) return;
  for (const std::int64_t id : ids) {
    const std::string given = exodus_name(file, type, id),
                      name = given.empty() ? fmt::format("{} {}", what, id) : given;
    if (std::ranges::find(choice, name) != choice.end())
      throw scene::bad_input(fmt::format(
          "{}: {} is a {}, which contains {} and no volume; name element blocks or element sets, which `tessera info` "
          "lists{}",
          source, quote(name), what, holds, type == EX_SIDE_SET ? " (`surface` shows side sets)" : ""));
  }
}

}  // namespace

std::string exodus_name(int file, ex_entity_type type, std::int64_t id) {
  std::array<char, 256> name{};
  ex_get_name(file, type, id, name.data());  // fails if the set has no name
  return {name.data(), ::strnlen(name.data(), name.size())};
}

ExodusSets::ExodusSets(int id, const ex_init_params& init, const cells::BlockChoice& choice, std::uint64_t most_values,
                       const std::string& source, const std::function<void(const std::string&)>& fail,
                       bool with_sides) {
  for (const std::int64_t set : ids_of(id, EX_ELEM_SET, init.num_elem_sets, most_values, fail)) {
    const std::string given = exodus_name(id, EX_ELEM_SET, set);
    names_.push_back(given.empty() ? fmt::format("element set {}", set) : given);
    if (choice.empty() || !cells::is_chosen(choice, names_.back())) continue;
    std::int64_t count = 0, factors = 0;
    if (ex_get_set_param(id, EX_ELEM_SET, set, &count, &factors) < 0) fail("an element set cannot be read");
    if (count < 0 || static_cast<std::uint64_t>(count) > most_values)
      fail(fmt::format("it states an element set of {} elements", count));
    std::vector<std::int64_t> numbers(static_cast<std::size_t>(count));
    if (!numbers.empty() && ex_get_set(id, EX_ELEM_SET, set, numbers.data(), nullptr) < 0)
      fail("an element set cannot be read");
    for (const std::int64_t number : numbers) {
      if (number < 1 || number > init.num_elem)
        throw scene::bad_input(
            fmt::format("{}: the element set {} refers to element {}, but the file has only {} elements; write sets "
                        "and elements from one mesh",
                        source, quote(names_.back()), number, init.num_elem));
      elements_.push_back(static_cast<std::uint64_t>(number) - 1);
    }
  }
  std::ranges::sort(elements_);
  elements_.erase(std::unique(elements_.begin(), elements_.end()), elements_.end());
  const std::vector<std::int64_t> sides = ids_of(id, EX_SIDE_SET, init.num_side_sets, most_values, fail);
  if (!with_sides) refuse(id, EX_SIDE_SET, sides, "side set", "faces", choice, source);
  for (const std::int64_t set : sides) {
    const std::string given = exodus_name(id, EX_SIDE_SET, set);
    (with_sides ? names_ : sides_left_out_).push_back(given.empty() ? fmt::format("side set {}", set) : given);
    if (with_sides && !choice.empty() && cells::is_chosen(choice, names_.back())) sides_.push_back(set);
  }
  refuse(id, EX_NODE_SET, ids_of(id, EX_NODE_SET, init.num_node_sets, most_values, fail), "node set", "points", choice,
         source);
}

std::vector<std::uint64_t> ExodusSets::chosen_of(std::uint64_t first, std::uint64_t count) const {
  const auto low = std::ranges::lower_bound(elements_, first),
             high = std::ranges::lower_bound(elements_, first + count);
  std::vector<std::uint64_t> chosen(low, high);
  for (std::uint64_t& element : chosen) element -= first;
  return chosen;
}

namespace {

constexpr std::uint8_t polygon = vtk_number(CellType::polygon);

/// Adds the faces of a side set if all of them are sides of solids. Otherwise adds nothing and returns false.
bool add_sides_of_solids(int file, std::span<const std::int64_t> elements, std::span<const std::int64_t> sides,
                         std::int64_t points, std::uint64_t most_values,
                         const std::function<void(const std::string&)>& fail, std::span<const SidesOf> blocks,
                         cells::CellBlock& block) {
  const auto block_of = [&](std::int64_t element) {
    return static_cast<std::size_t>(
        std::ranges::lower_bound(blocks, static_cast<std::uint64_t>(element), {}, &SidesOf::end) - blocks.begin());
  };
  for (std::size_t face = 0; face < elements.size(); ++face) {
    if (elements[face] < 1) return false;
    const std::size_t of = block_of(elements[face]);
    if (of == blocks.size() || exodus_side(blocks[of].topology, sides[face]).empty()) return false;
  }
  std::vector<std::vector<std::int64_t>> nodes(blocks.size());  // nodes of the blocks that the set uses
  for (std::size_t face = 0; face < elements.size(); ++face) {
    const std::size_t of = block_of(elements[face]);
    const std::uint64_t first = of == 0 ? 0 : blocks[of - 1].end;
    const auto each = static_cast<std::size_t>(blocks[of].nodes);
    if (nodes[of].empty()) {
      if (each == 0 || blocks[of].end - first > most_values / each)
        fail(fmt::format("it states {} elements with {} nodes", blocks[of].end - first, blocks[of].nodes));
      nodes[of].resize(each * (blocks[of].end - first));
      if (ex_get_conn(file, EX_ELEM_BLOCK, blocks[of].id, nodes[of].data(), nullptr, nullptr) < 0)
        fail("the elements cannot be read");
    }
    for (const std::uint8_t corner : exodus_side(blocks[of].topology, sides[face])) {
      if (corner >= each) fail(fmt::format("block {} has elements of {} nodes", blocks[of].id, each));
      const std::int64_t node = nodes[of][(static_cast<std::uint64_t>(elements[face]) - 1 - first) * each + corner];
      if (node < 1 || node > points)
        fail(fmt::format("a side set refers to node {}, but there are only {} nodes", node, points));
      block.connectivity.push_back(static_cast<std::uint32_t>(node - 1));
    }
    block.types.push_back(polygon);
    block.offsets.push_back(block.connectivity.size());
  }
  return true;
}

}  // namespace

void add_sides(int file, std::int64_t id, std::int64_t points, std::uint64_t most_values,
               const std::function<void(const std::string&)>& fail, std::span<const SidesOf> blocks,
               cells::CellBlock& block) {
  std::int64_t count = 0, factors = 0, length = 0;
  if (ex_get_set_param(file, EX_SIDE_SET, id, &count, &factors) < 0) fail("a side set cannot be read");
  if (count < 0 || static_cast<std::uint64_t>(count) > most_values)
    fail(fmt::format("it states a side set of {} faces", count));
  if (count == 0) return;
  std::vector<std::int64_t> elements(static_cast<std::size_t>(count)), sides(elements.size());
  if (ex_get_set(file, EX_SIDE_SET, id, elements.data(), sides.data()) < 0) fail("a side set cannot be read");
  if (add_sides_of_solids(file, elements, sides, points, most_values, fail, blocks, block)) return;
  if (ex_get_side_set_node_list_len(file, id, &length) < 0) fail("a side set cannot be read");
  // An element has at most 32 nodes in one face.
  if (length < 0 || length > 32 * count) fail(fmt::format("it states a side set of {} corners", length));
  std::vector<std::int64_t> counts(static_cast<std::size_t>(count)), nodes(static_cast<std::size_t>(length));
  if (ex_get_side_set_node_list(file, id, counts.data(), nodes.data()) < 0) fail("a side set cannot be read");
  std::size_t at = 0;
  for (const std::int64_t size : counts) {
    if (size < 0 || at + static_cast<std::size_t>(size) > nodes.size()) fail("a side set cannot be read");
    // Nodes of higher order follow the corners: 6 and 7 nodes form a triangle, 8 and 9 a quadrilateral.
    const std::int64_t corners = size == 6 || size == 7 ? 3 : size == 8 || size == 9 ? 4 : size;
    for (std::int64_t k = 0; k < corners; ++k) {
      const std::int64_t node = nodes[at + static_cast<std::size_t>(k)];
      if (node < 1 || node > points)
        fail(fmt::format("a side set refers to node {}, but there are only {} nodes", node, points));
      block.connectivity.push_back(static_cast<std::uint32_t>(node - 1));
    }
    block.types.push_back(polygon);
    block.offsets.push_back(block.connectivity.size());
    at += static_cast<std::size_t>(size);
  }
}

void keep_cells(cells::CellBlock& block, std::size_t first, const std::vector<std::uint64_t>& kept) {
  std::size_t cell = first;
  std::uint64_t end = block.offsets[first];
  const bool has_faces = block.face_locations.size() > first;
  for (const std::uint64_t number : kept) {
    const std::size_t from = first + number;
    const std::uint64_t low = block.offsets[from], high = block.offsets[from + 1];
    block.types[cell] = block.types[from];
    if (has_faces) block.face_locations[cell] = block.face_locations[from];
    for (std::uint64_t k = low; k < high; ++k) block.connectivity[end++] = block.connectivity[k];
    block.offsets[++cell] = end;
  }
  block.types.resize(cell);
  block.offsets.resize(cell + 1);
  block.connectivity.resize(end);
  if (has_faces) block.face_locations.resize(cell);
}

}  // namespace tessera::readers
