// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "tessera/dataset.hpp"

namespace tessera {

/// A box of n^3 cubes, each cut into six tets; the scalar is not linear.
struct Cubes {
  explicit Cubes(int n) {
    const auto point = [n](int i, int j, int k) { return static_cast<std::uint32_t>(i + (n + 1) * (j + (n + 1) * k)); };
    for (int k = 0; k <= n; ++k)
      for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
          points.insert(points.end(), {1.0 * i, 1.0 * j, 1.0 * k});
          scalars.push_back(i * j - 0.5 * k * i);
        }
    constexpr int orders[6][2] = {{1, 3}, {1, 5}, {2, 3}, {2, 6}, {4, 5}, {4, 6}};
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i, ++cubes)
          for (const auto& order : orders) {
            const auto corner = [&](int bits) {
              return point(i + (bits & 1), j + (bits >> 1 & 1), k + (bits >> 2 & 1));
            };
            tets.insert(tets.end(), {corner(0), corner(order[0]), corner(order[1]), corner(7)});
            cube_of.push_back(cubes);
          }
  }
  [[nodiscard]] MeshArrays arrays() const {
    MeshArrays arrays;
    arrays.points = points, arrays.tets = tets, arrays.scalars = scalars;
    return arrays;
  }
  std::vector<double> points, scalars;
  std::vector<std::uint32_t> tets;
  std::vector<std::uint64_t> cube_of;
  std::uint64_t cubes = 0;
};

}  // namespace tessera
