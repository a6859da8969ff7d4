// SPDX-License-Identifier: BSD-3-Clause
#include "cells/amr/amr_values.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace tessera::cells {
namespace {

AmrCubes leaf_cubes(const AmrLeaves& amr) {
  AmrCubes cubes;
  cubes.cubes.reserve(amr.leaves.size());
  for (const AmrLeaf& leaf : amr.leaves) {
    const std::int32_t size = amr.size[static_cast<std::size_t>(leaf.level)];
    cubes.cubes.push_back({leaf.low, size});
    for (unsigned k = 0; k < 8; ++k)
      cubes.corners.add({leaf.low[0] + ((k & 1) != 0 ? size : 0), leaf.low[1] + ((k & 2) != 0 ? size : 0),
                         leaf.low[2] + ((k & 4) != 0 ? size : 0)});
  }
  for (std::size_t level = 0; level + 1 < amr.size.size(); ++level)
    cubes.finer.emplace_back(amr.size[level], amr.size[level + 1]);
  return cubes;
}

/// Interpolates a block's point data between its points.
double value_at(const AmrLeaves::Part& part, std::int32_t size, std::span<const double> values, const AmrIndex& p) {
  std::array<std::size_t, 3> at{};
  std::array<double, 3> t{};
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int32_t n = p[a] - part.low[a], cell = std::min(n / size, part.cells[a] - 1);
    at[a] = static_cast<std::size_t>(cell);
    t[a] = static_cast<double>(n - cell * size) / size;
  }
  const auto row = static_cast<std::size_t>(part.cells[0]) + 1,
             slice = row * (static_cast<std::size_t>(part.cells[1]) + 1);
  double value = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    const double weight =
        ((k & 1) != 0 ? t[0] : 1 - t[0]) * ((k & 2) != 0 ? t[1] : 1 - t[1]) * ((k & 4) != 0 ? t[2] : 1 - t[2]);
    // A corner with weight 0 may hold NaN.
    if (weight > 0)
      value += weight * values[at[0] + (k & 1) + row * (at[1] + (k >> 1 & 1)) + slice * (at[2] + (k >> 2))];
  }
  return value;
}

}  // namespace

AmrCubes cubes_of_cells(const AmrLeaves& amr, std::vector<double> values) {
  AmrCubes cubes = leaf_cubes(amr);
  cubes.values = std::move(values);
  return cubes;
}

AmrCubes cubes_of_points(const AmrLeaves& amr, std::span<const std::vector<double>> points_of_parts) {
  AmrCubes cubes = leaf_cubes(amr);
  std::vector<bool> known(cubes.corners.size());
  cubes.values.resize(cubes.corners.size(), std::numeric_limits<double>::quiet_NaN());
  for (auto level = static_cast<std::int32_t>(amr.size.size()) - 1; level >= 0; --level)
    for (std::size_t l = 0; l < amr.leaves.size(); ++l) {
      const AmrLeaves::Part& part = amr.parts[amr.leaves[l].part];
      if (part.level != level) continue;
      const AmrCube& cube = cubes.cubes[l];
      for (unsigned k = 0; k < 8; ++k) {
        const AmrIndex p{cube.low[0] + ((k & 1) != 0 ? cube.size : 0), cube.low[1] + ((k & 2) != 0 ? cube.size : 0),
                         cube.low[2] + ((k & 4) != 0 ? cube.size : 0)};
        const std::uint32_t v = cubes.corners.find(p);
        if (known[v]) continue;
        known[v] = true;
        cubes.values[v] =
            value_at(part, amr.size[static_cast<std::size_t>(level)], points_of_parts[amr.leaves[l].part], p);
      }
    }
  return cubes;
}

}  // namespace tessera::cells
