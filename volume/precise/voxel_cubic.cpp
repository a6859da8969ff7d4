// SPDX-License-Identifier: BSD-3-Clause
#include "volume/precise/voxel_cubic.hpp"

#include <cmath>
#include <utility>

namespace tessera::volume {

std::array<double, 4> cubic_of(const std::array<double, 8>& corner, const glm::dvec3& front, const glm::dvec3& rise) {
  // Interpolates linearly along one axis after the other; each time, the degree of the polynomials increases by one.
  std::array<std::array<double, 4>, 8> p{};
  for (std::size_t n = 0; n < 8; ++n) p[n][0] = corner[n];
  for (int axis = 0; axis < 3; ++axis) {
    const double at = front[axis], change = rise[axis];
    for (std::size_t n = 0; n < (4u >> axis); ++n) {
      const std::array<double, 4> low = p[2 * n], high = p[2 * n + 1];
      for (std::size_t i = 0; i < static_cast<std::size_t>(axis) + 2; ++i) {
        p[n][i] = at == 1 ? high[i] : low[i] + (high[i] - low[i]) * at;
        if (i > 0) p[n][i] += (high[i - 1] - low[i - 1]) * change;
      }
    }
  }
  return p[0];
}

void turning_points(const std::array<double, 4>& p, std::array<double, 4>& ends, std::size_t& count) {
  const double a = 3 * p[3], b = 2 * p[2], c = p[1], discriminant = b * b - 4 * a * c;
  if (!(discriminant > 0)) return;
  const double q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
  double one = a != 0 ? q / a : -1, other = q != 0 ? c / q : -1;
  if (one > other) std::swap(one, other);
  for (const double u : {one, other})
    if (u > 0 && u < 1) ends[count++] = u;
  ends[count] = 1;
}

}  // namespace tessera::volume
