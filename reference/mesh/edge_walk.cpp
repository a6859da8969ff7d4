// SPDX-License-Identifier: BSD-3-Clause
#include "reference/mesh/edge_walk.hpp"

#include <algorithm>
#include <cmath>

namespace tessera::reference {

float nearness(double pixels) { return static_cast<float>(1e-6 / (1e-6 + std::abs(pixels))); }

void raise_ties(const glm::dvec3& a, const glm::dvec3& b, scene::ImageSize size, const SuspicionMap& edge,
                SuspicionMap& tie) {
  const double least = 1e-9 * std::max(std::abs(a.z), std::abs(b.z));
  if (!(std::max(a.z, b.z) > least)) return;
  const auto cut = [&](const glm::dvec3& p, const glm::dvec3& q) {
    return p.z >= least ? p : p + (q - p) * ((least - p.z) / (q.z - p.z));
  };
  const glm::dvec3 p = cut(a, b), q = cut(b, a);
  std::array<double, 2> from{p.x / p.z - 0.5, p.y / p.z - 0.5}, to{q.x / q.z - 0.5, q.y / q.z - 0.5};
  const std::array<int, 2> sides{size.width, size.height};
  // The walk steps along the longer axis of the edge, from one row of centres to the next.
  const std::size_t u = std::abs(to[0] - from[0]) > std::abs(to[1] - from[1]) ? 0 : 1, v = 1 - u;
  if (from[u] > to[u]) std::swap(from, to);
  const double first = std::max(0.0, std::ceil(from[u] - tying_distance));
  const double last = std::min(sides[u] - 1.0, std::floor(to[u] + tying_distance));
  const double length = to[u] - from[u], slope = length > 0 ? (to[v] - from[v]) / length : 0;
  for (double at = first; at <= last; ++at) {  // NOLINT(clang-analyzer-security.FloatLoopCounter): whole numbers
    const double across = from[v] + (std::clamp(at, from[u], to[u]) - from[u]) * slope;
    const double centre = std::nearbyint(across), away = across - centre;
    if (!(std::abs(away) <= tying_distance) || !(centre >= 0 && centre < sides[v])) continue;
    const auto x = static_cast<std::size_t>(u == 0 ? at : centre), y = static_cast<std::size_t>(u == 0 ? centre : at);
    const std::size_t pixel = y * static_cast<std::size_t>(size.width) + x;
    raise(tie[pixel], nearness(away) * (edge[pixel] + 1e-6f));
  }
}

}  // namespace tessera::reference
