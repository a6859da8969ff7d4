// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "datasets/arrays.hpp"
#include "datasets/boxes.hpp"
#include "scene/tet_mesh.hpp"
#include "tessera/communicator.hpp"
#include "tessera/dataset.hpp"

/// Data sets for queries in tests.
namespace tessera::tests {

template <class Field>
scene::TetMesh with_field(scene::TetMesh mesh, const Field& field) {
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.scalars[v] = field(mesh.positions[v]);
  return mesh;
}

/// Samples at n points along each axis of [-1, 1]^3; NaN is blank.
template <class Field>
Dataset grid_of(std::int64_t n, const Field& field) {
  const double spacing = 2.0 / static_cast<double>(n - 1);
  auto samples = std::make_shared<std::vector<double>>();
  for (std::int64_t k = 0; k < n; ++k)
    for (std::int64_t j = 0; j < n; ++j)
      for (std::int64_t i = 0; i < n; ++i)
        samples->push_back(field(glm::dvec3(-1) + spacing * glm::dvec3(static_cast<double>(i), static_cast<double>(j),
                                                                       static_cast<double>(k))));
  GridArrays arrays;
  arrays.geometry.points = {n, n, n};
  arrays.geometry.origin = glm::dvec3(-1);
  arrays.geometry.spacing = glm::dvec3(spacing);
  arrays.samples = *samples;
  arrays.owner = samples;
  return Dataset::of(arrays);
}

/// A rank's share of a mesh: a contiguous range of its tets.
inline Dataset part_of(const scene::TetMesh& mesh, const Communicator& communicator) {
  const std::size_t tets = mesh.tets.size(), rank = static_cast<std::size_t>(communicator.rank()),
                    size = static_cast<std::size_t>(communicator.size());
  std::vector<std::uint32_t> mine((rank + 1) * tets / size - rank * tets / size);
  std::iota(mine.begin(), mine.end(), static_cast<std::uint32_t>(rank * tets / size));
  return Dataset::of_parts(datasets::arrays_of(scene::subset(mesh, mine)), communicator);
}

}  // namespace tessera::tests
