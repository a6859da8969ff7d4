// SPDX-License-Identifier: BSD-3-Clause
#include "datasets/demo.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "datasets/kuhn.hpp"
#include "scene/error.hpp"

namespace tessera::datasets {
namespace {

const double pi = std::acos(-1.0);
constexpr double radius = 0.5, x_inflow = -2.5, x_outflow = 10.5, y_wall = 3, half_span = 1.5;

double bell(double x, double width) { return std::exp(-(x * x) / (width * width)); }
/// Returns 0 below `low`, 1 above `high`, and a smooth transition between.
double ramp(double x, double low, double high) {
  const double u = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return u * u * (3 - 2 * u);
}

/// One vortex of the street: number i, shed alternately from the upper and the lower side.
struct Vortex {
  glm::dvec2 centre;
  double core, strength, turn;  ///< turn: +1 counter-clockwise, -1 clockwise
};

/// Returns a vortex at span position z: the street's centre lines are wavy along the span, more so downstream.
Vortex vortex(int i, double z) {
  const double side = i % 2 == 0 ? 1 : -1, age = i;
  const double wave = (0.05 + 0.05 * age) * std::sin(2 * pi * z / 3 + 0.9 * age);
  return {{1.55 + 1.75 * age + wave, side * (0.38 + 0.05 * age)}, 0.34 + 0.045 * age, 1 / (1 + 0.12 * age), -side};
}

/// A core with a spiral arm, wound up by two turns of the vortex.
double rolled_up(const glm::dvec2& p, const Vortex& v) {
  const glm::dvec2 d = p - v.centre;
  const double r = glm::length(d), wound = std::atan2(d.y, d.x) * v.turn + 2.6 * r / v.core;
  const double arm = std::pow(0.5 + 0.5 * std::cos(wound), 3) * bell(r, 2.1 * v.core) * (1 - bell(r, 0.8 * v.core));
  return v.strength * (bell(r, v.core) + 0.55 * arm);
}

/// The thin sheet between two successive vortices, torn into ribs along the span.
double braid(const glm::dvec2& p, const Vortex& a, const Vortex& b, double z) {
  const glm::dvec2 along = b.centre - a.centre;
  const double length = glm::length(along), u = glm::dot(p - a.centre, along) / (length * length);
  if (u <= 0 || u >= 1) return 0;
  const double aside = (along.x * (p.y - a.centre.y) - along.y * (p.x - a.centre.x)) / length;
  const double bend = 0.22 * a.turn * std::sin(2 * pi * u);
  return 0.4 * b.strength * bell(aside - bend, 0.13) * ramp(std::min(u, 1 - u), 0, 0.25) *
         (0.55 + 0.45 * std::cos(2 * pi * z / 1.0));
}

double vorticity(const glm::dvec3& p_world) {
  const glm::dvec2 p(p_world.x, p_world.y);
  const double z = p_world.z, r = glm::length(p);
  double sum = 0;
  constexpr int count = 6;
  std::array<Vortex, count> street{};
  for (int i = 0; i < count; ++i) street[static_cast<std::size_t>(i)] = vortex(i, z);
  for (const Vortex& v : street) sum += rolled_up(p, v);
  for (std::size_t i = 0; i + 1 < count; ++i) sum += braid(p, street[i], street[i + 1], z);

  // The boundary layer from the stagnation point to separation near 100 degrees, and the shear layers that continue it.
  const double from_front = std::acos(std::clamp(-p.x / r, -1.0, 1.0));
  sum += 0.9 * std::exp(-(r - radius) / 0.07) * ramp(from_front, 0.2, 1.0) * (1 - ramp(from_front, 1.7, 2.3));
  for (const double side : {1.0, -1.0}) {
    const double centre =
        side * (0.5 + 0.1 * p.x - 0.05 * p.x * p.x) + 0.05 * std::sin(2 * pi * z / 3) * ramp(p.x, 0.2, 1);
    sum += 0.85 * bell(p.y - centre, 0.08 + 0.03 * p.x) * ramp(p.x, -0.05, 0.2) * (1 - ramp(p.x, 1.0, 2.2));
  }
  return std::min(sum, 1.0) * (1 - ramp(p.x, 9.6, 10.5));
}

}  // namespace

scene::TetMesh demo(double resolution) {
  if (!(resolution >= 0.2 && resolution <= 4)) throw scene::bad_input("demo: resolution must be in 0.2 .. 4");
  const auto scaled = [&](int n) { return static_cast<std::uint32_t>(std::lround(n * resolution)); };
  // Numbers of hexahedra along the four walls. The outflow has the largest number, because lines from the body to it
  // cross the wake.
  const std::uint32_t right = scaled(44), top = scaled(28), left = scaled(12);
  const Lattice lattice{right + top + left + top, scaled(64), scaled(12), true};

  // Points go around the box from the lower right corner, counter-clockwise.
  const auto wall = [&](std::uint32_t i) {
    const auto part = [](std::uint32_t a, std::uint32_t n) { return static_cast<double>(a) / n; };
    const double width = x_outflow - x_inflow, height = 2 * y_wall;
    if (i < right) return glm::dvec2(x_outflow, -y_wall + height * part(i, right));
    if ((i -= right) < top) return glm::dvec2(x_outflow - width * part(i, top), y_wall);
    if ((i -= top) < left) return glm::dvec2(x_inflow, y_wall - height * part(i, left));
    return glm::dvec2(x_inflow + width * part(i - left, top), -y_wall);
  };

  scene::TetMesh mesh;
  mesh.field_name = "vorticity";
  mesh.positions.reserve(lattice.vertices());
  mesh.scalars.reserve(lattice.vertices());
  for (std::uint32_t i = 0; i < lattice.nx; ++i) {
    const double angle = 2 * pi * (i - 0.5 * right) / lattice.nx;
    const glm::dvec2 body = radius * glm::dvec2(std::cos(angle), std::sin(angle)), rim = wall(i);
    for (std::uint32_t j = 0; j <= lattice.ny; ++j) {
      const double u = static_cast<double>(j) / lattice.ny, g = u * (0.35 + 0.65 * u);  // finer at the body
      const glm::dvec2 p = body + g * (rim - body);
      for (std::uint32_t k = 0; k <= lattice.nz; ++k)
        mesh.positions.emplace_back(p.x, p.y, half_span * (2.0 * k / lattice.nz - 1));
    }
  }
  for (const glm::dvec3& p : mesh.positions) mesh.scalars.push_back(vorticity(p));
  mesh.tets = lattice.tets();
  orient(mesh);
  return mesh;
}

}  // namespace tessera::datasets
