// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/kuhn.hpp"

#include <glm/geometric.hpp>
#include <utility>

namespace tessera::datasets {

void append_kuhn(const std::array<std::uint32_t, 8>& corners, std::vector<scene::Tet>& tets) {
  // Each tet goes from corner 0 to corner 7 along the three axes in one order; odd permutations swap two vertices so
  // that all volumes are positive.
  constexpr std::array<std::array<int, 4>, 6> walks{
      {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};
  for (const auto& w : walks) tets.push_back({corners[w[0]], corners[w[1]], corners[w[2]], corners[w[3]]});
}

void append_prism(std::array<std::uint32_t, 3> low, std::array<std::uint32_t, 3> high, std::vector<scene::Tet>& tets) {
  const auto order = [&](int a, int b) {
    if (low[a] > low[b]) {
      std::swap(low[a], low[b]);
      std::swap(high[a], high[b]);
    }
  };
  order(0, 1);
  order(1, 2);
  order(0, 1);
  tets.push_back({low[0], low[1], low[2], high[2]});
  tets.push_back({low[0], low[1], high[1], high[2]});
  tets.push_back({low[0], high[0], high[1], high[2]});
}

std::array<std::uint32_t, 8> Lattice::corners(std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
  std::array<std::uint32_t, 8> c{};
  for (std::uint32_t b = 0; b < 8; ++b) c[b] = vertex(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2 & 1));
  return c;
}

std::vector<scene::Tet> Lattice::tets() const {
  std::vector<scene::Tet> tets;
  tets.reserve(std::size_t{6} * nx * ny * nz);
  for (std::uint32_t i = 0; i < nx; ++i)
    for (std::uint32_t j = 0; j < ny; ++j)
      for (std::uint32_t k = 0; k < nz; ++k) append_kuhn(corners(i, j, k), tets);
  return tets;
}

double signed_volume_6(const scene::TetMesh& mesh, const scene::Tet& tet) {
  const glm::dvec3& a = mesh.positions[tet[0]];
  return glm::dot(glm::cross(mesh.positions[tet[1]] - a, mesh.positions[tet[2]] - a), mesh.positions[tet[3]] - a);
}

void orient(scene::TetMesh& mesh) {
  for (scene::Tet& tet : mesh.tets)
    if (signed_volume_6(mesh, tet) < 0) std::swap(tet[2], tet[3]);
}

}  // namespace tessera::datasets
