#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <random>

#include "scene/tet_mesh.hpp"

namespace tessera::tests {

/// A smooth scalar in [0, 1] that is not linear.
inline double smooth_field(const glm::dvec3& p) {
  return std::clamp(0.5 + 0.25 * std::sin(5 * p.x) * std::cos(4 * p.y + p.z) + 0.25 * std::cos(6 * glm::length(p)), 0.0,
                    1.0);
}

/// The box [low, high] cut into n^3 voxels of six tets each (Kuhn's split: one a permutation of the axes); inner
/// vertices moved by up to `jitter` voxels.
inline scene::TetMesh split_box(int n, const glm::dvec3& low, const glm::dvec3& high, double jitter,
                                std::uint32_t seed = 7) {
  scene::TetMesh mesh;
  std::mt19937 random(seed);
  const auto shift = [&] { return jitter * (2.0 * random() / 4294967296.0 - 1); };
  const int m = n + 1;
  const auto inner = [&](int i) { return i > 0 && i < n; };
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j)
      for (int k = 0; k < m; ++k) {
        glm::dvec3 g(i, j, k);
        if (jitter > 0 && inner(i) && inner(j) && inner(k)) g += glm::dvec3(shift(), shift(), shift());
        mesh.positions.push_back(low + (high - low) * (g / static_cast<double>(n)));
        mesh.scalars.push_back(smooth_field(mesh.positions.back()));
      }
  constexpr int axes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (const auto& order : axes) {
          std::array<int, 3> at{i, j, k};
          const auto vertex = [&] { return static_cast<std::uint32_t>((at[0] * m + at[1]) * m + at[2]); };
          scene::Tet tet{vertex(), 0, 0, 0};
          for (int step = 0; step < 3; ++step) {
            ++at[order[step]];
            tet[step + 1] = vertex();
          }
          mesh.tets.push_back(tet);
        }
  return mesh;
}

/// The same mesh with one scalar a tet: the mean of its corners.
inline scene::TetMesh with_cell_data(scene::TetMesh mesh) {
  std::vector<double> means;
  for (const scene::Tet& t : mesh.tets)
    means.push_back(0.25 * (mesh.scalars[t[0]] + mesh.scalars[t[1]] + mesh.scalars[t[2]] + mesh.scalars[t[3]]));
  mesh.scalars = means;
  mesh.association = scene::Association::cell;
  return mesh;
}

}  // namespace tessera::tests
