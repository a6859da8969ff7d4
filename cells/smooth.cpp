// SPDX-License-Identifier: BSD-3-Clause
#include <bit>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "cells/mesh_assembly.hpp"
#include "cells/mix_bits.hpp"

namespace tessera::cells {
namespace {

/// Returns, for each used vertex, the first used vertex at the same position. Open addressing, linear probing.
std::vector<std::uint32_t> first_at_same_position(const scene::TetMesh& mesh) {
  constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
  const std::size_t slots = std::bit_ceil(2 * mesh.positions.size() + 1);
  std::vector<std::uint32_t> table(slots, none), first(mesh.positions.size(), none);
  for (const scene::Tet& tet : mesh.tets)
    for (const std::uint32_t v : tet) {
      if (first[v] != none) continue;
      const glm::dvec3& p = mesh.positions[v];
      std::size_t slot = mix(std::bit_cast<std::uint64_t>(p.x) ^
                             mix(std::bit_cast<std::uint64_t>(p.y) ^ mix(std::bit_cast<std::uint64_t>(p.z)))) &
                         (slots - 1);
      while (table[slot] != none && mesh.positions[table[slot]] != p) slot = (slot + 1) & (slots - 1);
      if (table[slot] == none) table[slot] = v;
      first[v] = table[slot];
    }
  return first;
}

}  // namespace

void smooth_to_points(scene::TetMesh& mesh) {
  if (mesh.association == scene::Association::point) return;
  const std::vector<std::uint32_t> first = first_at_same_position(mesh);
  struct Mean {
    double weighted = 0, volume = 0, plain = 0;
    std::uint32_t count = 0;
  };
  std::vector<Mean> means(mesh.positions.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const scene::Tet& tet = mesh.tets[t];
    const glm::dvec3 a = mesh.positions[tet[0]], b = mesh.positions[tet[1]] - a, c = mesh.positions[tet[2]] - a,
                     d = mesh.positions[tet[3]] - a;
    const double volume = std::abs(glm::dot(glm::cross(b, c), d));
    for (const std::uint32_t v : tet) {
      Mean& mean = means[first[v]];
      mean.weighted += volume * mesh.scalars[t];
      mean.volume += volume;
      mean.plain += mesh.scalars[t];
      ++mean.count;
    }
  }
  std::vector<double> scalars(mesh.positions.size(), 0.0);
  for (const scene::Tet& tet : mesh.tets)
    for (const std::uint32_t v : tet) {
      const Mean& mean = means[first[v]];
      const double weighted = mean.weighted / mean.volume;  // not finite if volumes are 0, underflow or overflow
      scalars[v] = std::isfinite(weighted) ? weighted : mean.plain / mean.count;
    }
  mesh.scalars = std::move(scalars);
  mesh.association = scene::Association::point;
}

}  // namespace tessera::cells
