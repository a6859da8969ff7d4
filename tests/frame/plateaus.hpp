// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

#include "datasets/boxes.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::frame {

enum class LastPlace { of_float, of_double };

/// Returns the number that is `places` last places above `value`, or below it if `places` is negative.
inline double beside(double value, int places, LastPlace kind) {
  const double step = kind == LastPlace::of_float ? double{std::nextafter(static_cast<float>(value), 1e30f)} - value
                                                  : std::nextafter(value, 1e300) - value;
  const double below = kind == LastPlace::of_float ? value - double{std::nextafter(static_cast<float>(value), -1e30f)}
                                                   : value - std::nextafter(value, -1e300);
  return value + places * (places > 0 ? step : below);
}

/// A cube whose field increases from 0 to `level` and stays there, except for noise of up to `places` last places; with
/// cell data if `cells`.
inline scene::TetMesh plateau(double level, int places, LastPlace kind, bool cells, std::uint64_t seed) {
  scene::TetMesh mesh = datasets::cube(5, 0.2);
  std::mt19937_64 random(seed);
  std::uniform_int_distribution<int> noise(-1, 1);
  const auto field = [&](const glm::dvec3& p) {
    const double u = p.x + 0.3 * p.y + 0.2 * p.z;
    if (u < -0.5) return static_cast<double>(static_cast<float>(level * std::max(0.0, 1.6 + 1.2 * u)));
    return beside(level, places * noise(random), kind);
  };
  std::vector<double> scalars;
  if (cells) {
    mesh.association = scene::Association::cell;
    for (const scene::Tet& t : mesh.tets) {
      glm::dvec3 middle(0);
      for (const std::uint32_t v : t) middle += mesh.positions[v] / 4.0;
      scalars.push_back(field(middle));
    }
  } else {
    for (const glm::dvec3& p : mesh.positions) scalars.push_back(field(p));
  }
  mesh.scalars = std::move(scalars);
  return mesh;
}

/// A function that is almost clear below `level` and dense from `level` on (or the reverse, without `up`), with another
/// step at half of `level`.
inline scene::TransferFunction step_at(double level, bool up) {
  const scene::Knot clear{level, {0.1, 0.2, 0.9}, 0.05}, dense{level, {0.9, 0.6, 0.1}, 3};
  const glm::dvec3 green(0.2, 0.9, 0.2);
  return scene::TransferFunction({{0, green, 0.1},
                                  {level / 2, green, 0.1},
                                  {level / 2, {0.5, 0.1, 0.8}, 0.6},
                                  up ? clear : dense,
                                  up ? dense : clear,
                                  {1.5 * level, {0.9, 0.9, 0.9}, 3}});
}

}  // namespace tessera::frame
