// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/volume_fields.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>

namespace tessera::datasets {
namespace {

/// Returns a random number in [0, 1) that is the same on any machine: computed without a library's random numbers and
/// without sines of large numbers.
double at_lattice(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u +
                    static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu +
                    static_cast<std::uint64_t>(z) * 0x165667b19e3779f9u;
  h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9u;
  h = (h ^ (h >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((h ^ (h >> 31)) >> 11) * 0x1p-53;
}

double smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Interpolates, smoothly, random numbers in [-1, 1) at the points of a unit lattice.
double noise(const glm::dvec3& p) {
  const glm::dvec3 low = glm::floor(p);
  const auto x = static_cast<std::int64_t>(low.x), y = static_cast<std::int64_t>(low.y),
             z = static_cast<std::int64_t>(low.z);
  const double u = smooth_step(p.x - low.x), v = smooth_step(p.y - low.y), w = smooth_step(p.z - low.z);
  const auto along_x = [&](std::int64_t j, std::int64_t k) {
    return (1 - u) * at_lattice(x, y + j, z + k) + u * at_lattice(x + 1, y + j, z + k);
  };
  const double near = (1 - v) * along_x(0, 0) + v * along_x(1, 0), far = (1 - v) * along_x(0, 1) + v * along_x(1, 1);
  return 2 * ((1 - w) * near + w * far) - 1;
}

/// Sums octaves of noise, each with half the amplitude and twice the frequency of the previous one. The first has
/// `scale` lattice points per unit.
double octaves(const glm::dvec3& p, double scale, int count) {
  double sum = 0, amplitude = 0.5;
  for (int n = 0; n < count; ++n, scale *= 2, amplitude /= 2) sum += amplitude * noise(p * scale + 17.0 * n);
  return sum;
}

/// Returns 1 where `inside` > 0, 0 where it is below -width, and a smooth transition between.
double edge(double inside, double width) { return smooth_step(inside / width + 1); }

}  // namespace

double radial_field(const glm::dvec3& p) { return std::max(0.0, 1 - glm::length(p) / std::sqrt(3.0)); }

double head_field(const glm::dvec3& p) {
  const double rough = octaves(p, 12, 2);
  // Distances are in units of half the volume's side, and valid near the surfaces.
  const double wall = 0.88 * (1 - std::hypot((p.x - 0.03 * p.z) / 0.92, (p.y + 0.04 * p.z) / 0.85));
  const double in_case = edge(wall, 0.02) * edge(0.075 - wall, 0.02);
  const glm::dvec3 q = (p - glm::dvec3(0, 0.03, 0.1)) / glm::dvec3(0.57, 0.68, 0.71);
  const double depth = 0.6 * (1 - glm::length(q));
  const double neck = std::min(0.3 - std::hypot(p.x, p.y - 0.1), 0.1 - p.z);
  const double tissue = edge(std::max(depth, neck) + 0.02 * rough, 0.02);
  const double skull = edge(depth - 0.07, 0.02) * edge(0.13 - depth, 0.02);
  const double hollow = edge(depth - 0.16, 0.02) * edge(0.1 + 0.25 * rough + p.z, 0.1);
  const double flesh = tissue * (0.45 + 0.08 * rough) * (1 - hollow);
  return std::clamp(std::max({0.4 * in_case, flesh, skull * (0.9 + 0.08 * rough)}), 0.0, 1.0);
}

double turbulence_field(const glm::dvec3& p) {
  const double height = p.z + 1.1 * octaves(p, 2.4, 6);
  const double mixed = smooth_step(0.5 + height / 0.66);
  return std::clamp(0.1 + 0.8 * mixed + 0.12 * octaves(p + 5.0, 16, 4), 0.0, 1.0);
}

}  // namespace tessera::datasets
