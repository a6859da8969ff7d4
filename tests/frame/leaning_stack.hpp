// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "datasets/boxes.hpp"
#include "datasets/kuhn.hpp"

namespace tessera::frame {

/// A stack of `layers` slabs with a small square as base, next to a coarse box. Each slab has 6 tets and is so oblique
/// that all slabs overlap in depth.
inline scene::TetMesh leaning_stack(int layers) {
  scene::TetMesh mesh = datasets::cube(2, 0);
  const double side = 0.02, lean = 2.0;
  const auto base = static_cast<std::uint32_t>(mesh.positions.size());
  for (int layer = 0; layer <= layers; ++layer) {
    const double z = 1.5 + 1.0 * layer / layers;
    for (const double x : {0.0, side})
      for (const double y : {0.0, side}) {
        mesh.positions.emplace_back(x, y, z + lean * x / side);
        mesh.scalars.push_back(0.5 + 0.5 * std::sin(0.01 * layer));
      }
  }
  for (int layer = 0; layer < layers; ++layer) {
    std::array<std::uint32_t, 8> corners;
    for (std::uint32_t b = 0; b < 8; ++b)
      corners[b] = base + 4 * (static_cast<std::uint32_t>(layer) + (b >> 2)) + 2 * (b & 1) + (b >> 1 & 1);
    datasets::append_kuhn(corners, mesh.tets);
  }
  return mesh;
}

}  // namespace tessera::frame
