// SPDX-License-Identifier: BSD-3-Clause
#include "cells/warp.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "scene/error.hpp"
#include "tessera/program/nearest_name.hpp"
#include "tessera/program/text.hpp"

namespace tessera::cells {
namespace {

bool is_point_vector(const BlockField& field) {
  return field.association == scene::Association::point && field.components == 3;
}

std::vector<std::string> point_vectors(const MeshBlocks& read) {
  std::vector<std::string> names;
  for (const CellBlock& block : read.blocks)
    for (const BlockField& field : block.fields)
      if (is_point_vector(field) && std::ranges::find(names, field.name) == names.end()) names.push_back(field.name);
  return names;
}

void move_points(CellBlock& block, const BlockField& vector, double factor) {
  std::vector<double> some(std::min<std::size_t>(block.positions.size(), 65536));
  for (std::size_t first = 0; first < block.positions.size(); first += some.size()) {
    const std::span chunk = std::span(some).first(std::min(some.size(), block.positions.size() - first));
    for (int axis = 0; axis < 3; ++axis) {
      vector.read(axis, first, chunk);
      for (std::size_t k = 0; k < chunk.size(); ++k) block.positions[first + k][axis] += factor * chunk[k];
    }
  }
}

scene::Error unknown_vector(const std::string& name, std::span<const std::string> names, const std::string& source) {
  if (names.empty())
    return scene::bad_input(fmt::format(
        "{}: `warp`: it has no vectors at its points, so '{}' cannot be one; leave `warp` out", source, name));
  const auto near = nearest_name(name, names);
  return scene::bad_input(fmt::format("{}: `warp`: there is no point vector '{}'; {}it has '{}'", source, name,
                                      near ? fmt::format("did you mean '{}'? ", *near) : "", fmt::join(names, "', '")));
}

}  // namespace

bool is_displacement_name(const std::string& name) {
  static constexpr std::array words = {"dis", "disp", "disps", "displ", "displs", "displacement", "displacements"};
  std::string lower = lower_case(name);
  while (lower.ends_with('_') || lower.ends_with(' ')) lower.pop_back();
  return std::ranges::find(words, lower) != words.end();
}

void warp(MeshBlocks& read, const std::optional<Warp>& request, const std::string& source) {
  Warp by = request.value_or(Warp());
  if (!request && read.format.starts_with("Exodus"))
    for (const std::string& name : point_vectors(read))
      if (by.vector.empty() && is_displacement_name(name)) by.vector = name;
  if (by.vector.empty()) return;
  if (!read.fields.empty())  // the reader has loaded only the chosen field (MeshBlocks::fields)
    throw scene::bad_input(
        fmt::format("{}: `warp`: a mesh with levels of refinement cannot be moved; leave `warp` out", source));
  std::size_t moved = 0;
  for (CellBlock& block : read.blocks)
    for (const BlockField& field : block.fields)
      if (is_point_vector(field) && field.name == by.vector) {
        move_points(block, field, by.factor);
        ++moved;
        break;
      }
  if (moved == 0 && !read.blocks.empty()) throw unknown_vector(by.vector, point_vectors(read), source);
  if (moved == 0) return;
  add_notes({by.factor == 1 ? fmt::format("nodes are displaced by '{}'", by.vector)
                            : fmt::format("nodes are displaced by {:g} times '{}'", by.factor, by.vector)},
            read.notes);
  if (moved < read.blocks.size())
    add_notes({fmt::format("some blocks have no '{}': their nodes are not moved", by.vector)}, read.notes);
}

}  // namespace tessera::cells
