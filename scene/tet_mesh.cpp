// SPDX-License-Identifier: BSD-3-Clause
#include "scene/tet_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "scene/error.hpp"
#include "scene/mesh_facts.hpp"
#include "scene/sum_over_tets.hpp"

namespace tessera::scene {

Box bounds(const TetMeshView& mesh) {
  const auto join = [](const Box& a, const Box& b) { return Box{glm::min(a.low, b.low), glm::max(a.high, b.high)}; };
  const auto of = [&](std::size_t first, std::size_t last) {
    Box box;
    for (std::size_t t = first; t < last; ++t)
      for (const std::uint32_t v : mesh.tets[t]) box = join(box, {mesh.positions[v], mesh.positions[v]});
    return box;
  };
  const Box box = sum_over_tets(mesh.tets.size(), Box(), of, join);
  // -0 becomes 0: otherwise the result would depend on the order.
  return {box.low + 0.0, box.high + 0.0};
}

double mean_thickness(const TetMeshView& mesh) {
  const Box box = bounds(mesh);
  return mean_thickness(box, volume_sum(mesh, box));
}

std::array<double, 2> scalar_range(const TetMeshView& mesh) {
  if (mesh.tets.empty()) return {0, 0};
  using Range = std::array<double, 2>;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const auto join = [](const Range& a, const Range& b) { return Range{std::min(a[0], b[0]), std::max(a[1], b[1])}; };
  const auto of = [&](std::size_t first, std::size_t last) {
    Range range{infinity, -infinity};
    const auto include = [&](double s) { range = join(range, {s, s}); };
    for (std::size_t t = first; t < last; ++t) {
      if (mesh.association == Association::cell)
        include(mesh.scalars[t]);
      else
        for (const std::uint32_t v : mesh.tets[t]) include(mesh.scalars[v]);
    }
    return range;
  };
  const auto [low, high] = sum_over_tets(mesh.tets.size(), Range{infinity, -infinity}, of, join);
  return {low + 0.0, high + 0.0};  // -0 becomes 0, as in bounds()
}

TetMesh subset(const TetMeshView& mesh, std::span<const std::uint32_t> tets) {
  TetMesh part;
  part.association = mesh.association;
  part.field_name = mesh.field_name;
  std::vector<std::uint32_t> vertices;
  vertices.reserve(4 * tets.size());
  for (const std::uint32_t t : tets) vertices.insert(vertices.end(), mesh.tets[t].begin(), mesh.tets[t].end());
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  const bool point = mesh.association == Association::point;
  for (const std::uint32_t v : vertices) {
    part.positions.push_back(mesh.positions[v]);
    if (point) part.scalars.push_back(mesh.scalars[v]);
  }
  for (const std::uint32_t t : tets) {
    Tet tet = mesh.tets[t];
    for (std::uint32_t& v : tet)
      v = static_cast<std::uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), v) - vertices.begin());
    part.tets.push_back(tet);
    if (!point) part.scalars.push_back(mesh.scalars[t]);
    if (!mesh.original_cell.empty()) part.original_cell.push_back(mesh.original_cell[t]);
  }
  return part;
}

void validate(const TetMeshView& mesh, const std::string& source) {
  const bool point = mesh.association == Association::point;
  const std::size_t expected = point ? mesh.positions.size() : mesh.tets.size();
  if (mesh.scalars.size() != expected)
    throw bad_input(fmt::format("{}: there are {} scalars for {} {}; give one for each", source, mesh.scalars.size(),
                                expected, point ? "points" : "cells"));
  if (!mesh.original_cell.empty() && mesh.original_cell.size() != mesh.tets.size())
    throw bad_input(fmt::format("{}: there are {} original cell numbers for {} tets", source, mesh.original_cell.size(),
                                mesh.tets.size()));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!point && !std::isfinite(mesh.scalars[t]))
      throw bad_input(fmt::format("{}: cell {} has a scalar that is not finite; blank it", source, mesh.cell_of(t)));
    for (const std::uint32_t v : mesh.tets[t]) {
      if (v >= mesh.positions.size())
        throw bad_input(fmt::format(
            "{}: cell {} uses vertex {}, but the mesh has only {} vertices; write cells and points from one mesh",
            source, mesh.cell_of(t), v, mesh.positions.size()));
      const glm::dvec3& p = mesh.positions[v];
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        throw bad_input(
            fmt::format("{}: vertex {} of cell {} is not finite; blank the cell", source, v, mesh.cell_of(t)));
      if (point && !std::isfinite(mesh.scalars[v]))
        throw bad_input(fmt::format("{}: vertex {} of cell {} has a scalar that is not finite; blank the cell", source,
                                    v, mesh.cell_of(t)));
    }
  }
}

}  // namespace tessera::scene
