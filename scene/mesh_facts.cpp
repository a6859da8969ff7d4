// SPDX-License-Identifier: BSD-3-Clause
#include "scene/mesh_facts.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/sum_over_tets.hpp"

namespace tessera::scene {
namespace {

/// Longest side of the box; 0 if the box has no extent, or if a double cannot represent the extent.
double longest_side(const Box& box) {
  if (box.empty()) return 0;
  const glm::dvec3 side = box.high - box.low;
  const double longest = std::max({side.x, side.y, side.z});
  return std::isfinite(longest) ? longest : 0;
}

}  // namespace

MeshFacts facts_of(const TetMeshView& mesh) {
  MeshFacts facts{bounds(mesh), scalar_range(mesh), 0, mesh.tets.size(), mesh.association};
  facts.mean_thickness = mean_thickness(facts.box, volume_sum(mesh, facts.box));
  return facts;
}

MeshFacts joined(const MeshFacts& a, const MeshFacts& b) {
  if (a.tets == 0) return b;
  if (b.tets == 0) return a;
  return {{glm::min(a.box.low, b.box.low), glm::max(a.box.high, b.box.high)},
          {std::min(a.scalar_range[0], b.scalar_range[0]), std::max(a.scalar_range[1], b.scalar_range[1])},
          0,
          a.tets + b.tets,
          a.association};
}

VolumeSum volume_sum(const TetMeshView& mesh, const Box& box) {
  const double longest = longest_side(box);
  if (!(longest > 0)) return 0;
  const auto volume_of = [&](const Tet& tet) {
    const glm::dvec3 &a = mesh.positions[tet[0]], &b = mesh.positions[tet[1]], &c = mesh.positions[tet[2]],
                     &d = mesh.positions[tet[3]];
    // Lengths are in units of the longest side, so that meshes of size 1e-150 or 1e150 neither underflow nor overflow.
    const double volume =
        std::abs(glm::dot((b - a) / longest, glm::cross((c - a) / longest, (d - a) / longest))) / 6;  // at most 1/3
    // The conversion has two steps of 64 bits, because converting a double to 128 bits is a slow function call.
    const double upper = volume * 0x1p62;
    const auto whole = static_cast<std::int64_t>(upper);
    const auto rest = static_cast<std::int64_t>((upper - static_cast<double>(whole)) * 0x1p38);
    return (static_cast<VolumeSum>(whole) << 38) + rest;
  };
  const auto of = [&](std::size_t first, std::size_t last) {
    VolumeSum sum = 0;
    for (std::size_t t = first; t < last; ++t) sum += volume_of(mesh.tets[t]);
    return sum;
  };
  return sum_over_tets(mesh.tets.size(), VolumeSum{0}, of, std::plus<>());
}

double mean_thickness(const Box& box, VolumeSum volume) {
  const double longest = longest_side(box);
  if (!(longest > 0)) return 0;
  const glm::dvec3 s = (box.high - box.low) / longest;
  return static_cast<double>(volume) * 0x1p-100 / std::max({s.x * s.y, s.y * s.z, s.z * s.x, 1e-300}) * longest;
}

}  // namespace tessera::scene
