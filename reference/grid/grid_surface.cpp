// SPDX-License-Identifier: BSD-3-Clause
#include "reference/grid/grid_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tessera::reference {
namespace {

using Real = long double;
using Place = std::array<Real, 3>;
using Corners = std::array<Real, 8>;

constexpr Real on_side = 1e-11L, on_level = 1e-10L;

Place snapped(const glm::dvec3& place) {
  Place result;
  for (int a = 0; a < 3; ++a) {
    const Real p = place[a];
    result[static_cast<std::size_t>(a)] = std::abs(p) < on_side ? 0 : std::abs(p - 1) < on_side ? 1 : p;
  }
  return result;
}

Real field_at(Corners v, const Place& place) {
  std::size_t count = 8;
  for (const Real p : place) {
    count /= 2;
    for (std::size_t i = 0; i < count; ++i) v[i] = p == 1 ? v[2 * i + 1] : v[2 * i] + (v[2 * i + 1] - v[2 * i]) * p;
  }
  return v[0];
}

Place between(const Place& front, const Place& back, Real u) {
  Place place;
  for (std::size_t a = 0; a < 3; ++a)
    place[a] = u == 0 ? front[a] : u == 1 ? back[a] : front[a] + (back[a] - front[a]) * u;
  return place;
}

/// Returns 0, the turning points of the field along the segment in (0, 1), and 1. They are computed from the cubic
/// through four values of the field.
std::vector<Real> turns(const Corners& v, const Place& front, const Place& back) {
  std::array<Real, 4> f;
  for (std::size_t n = 0; n < 4; ++n) f[n] = field_at(v, between(front, back, static_cast<Real>(n) / 3));
  // The cubic as a function of t = 3 u, by Newton's forward differences.
  const Real d1 = f[1] - f[0], d2 = f[2] - 2 * f[1] + f[0], d3 = f[3] - 3 * f[2] + 3 * f[1] - f[0];
  const Real c3 = d3 / 6, c2 = d2 / 2 - d3 / 2, c1 = d1 - d2 / 2 + d3 / 3;
  std::vector<Real> ends{0};
  const Real a = 3 * c3, b = 2 * c2, discriminant = b * b - 4 * a * c1;
  if (discriminant > 0) {
    const Real q = -(b + std::copysign(std::sqrt(discriminant), b)) / 2;
    for (const Real t : {a != 0 ? q / a : -1, q != 0 ? c1 / q : -1})
      if (t > 0 && t < 3) ends.push_back(t / 3);
    std::sort(ends.begin(), ends.end());
  }
  ends.push_back(1);
  return ends;
}

}  // namespace

std::vector<GridCrossing> surface_crossings(std::span<const SurfaceOfValue> surfaces, const VoxelStretch& stretch) {
  std::vector<GridCrossing> found;
  const auto [low, high] = std::minmax_element(stretch.corner.begin(), stretch.corner.end());
  const Real size = std::max(std::abs(*low), std::abs(*high));
  const Place front = snapped(stretch.front), back = snapped(stretch.back);
  std::vector<Real> ends;
  struct OfSurface {
    const SurfaceOfValue* surface;
    Corners corner;
    std::vector<Real> value;  ///< at the ends, relative to the surface's
  };
  std::vector<OfSurface> met;
  for (const SurfaceOfValue& surface : surfaces) {
    if (surface.value < *low - on_level * size || surface.value > *high + on_level * size) continue;
    OfSurface one{&surface, {}, {}};
    for (std::size_t i = 0; i < 8; ++i) one.corner[i] = static_cast<Real>(stretch.corner[i]) - surface.value;
    if (ends.empty()) ends = turns(one.corner, front, back);
    for (const Real u : ends) one.value.push_back(field_at(one.corner, between(front, back, u)));
    if (stretch.front_cut && std::abs(one.value.front()) <= on_level * size) one.value.front() = 0;
    if (stretch.back_cut && std::abs(one.value.back()) <= on_level * size) one.value.back() = 0;
    met.push_back(std::move(one));
  }
  for (std::size_t e = 0; e + 1 < ends.size(); ++e) {
    const std::size_t before = found.size();
    bool falls = false;
    for (const OfSurface& one : met) {
      const bool below = one.value[e] < 0;
      if (below == (one.value[e + 1] < 0)) continue;
      falls = !below;
      Real u0 = ends[e], u1 = ends[e + 1];
      for (int n = 0; n < 70; ++n) {
        const Real middle = (u0 + u1) / 2;
        ((field_at(one.corner, between(front, back, middle)) < 0) == below ? u0 : u1) = middle;
      }
      const Place place = between(front, back, u1);
      found.push_back({static_cast<double>(u1), glm::dvec3(place[0], place[1], place[2]), one.surface});
    }
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(before);
    if (falls) std::reverse(first, found.end());
    for (std::size_t i = std::max<std::size_t>(before, 1); i < found.size(); ++i)
      found[i].part = std::max(found[i].part, found[i - 1].part);
  }
  return found;
}

glm::dvec3 slopes(const std::array<double, 8>& corner, const glm::dvec3& place) {
  glm::dvec3 sum(0);
  for (std::size_t n = 0; n < 8; ++n) {
    glm::dvec3 share, change;
    for (int a = 0; a < 3; ++a) {
      const bool far = (n >> a & 1) != 0;
      share[a] = far ? place[a] : 1 - place[a];
      change[a] = far ? 1 : -1;
    }
    const double v = corner[n] - corner[0];
    sum += v * glm::dvec3(change.x * share.y * share.z, share.x * change.y * share.z, share.x * share.y * change.z);
  }
  return sum;
}

}  // namespace tessera::reference
