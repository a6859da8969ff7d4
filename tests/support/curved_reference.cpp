// SPDX-License-Identifier: BSD-3-Clause
#include "support/curved_reference.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

#include "support/mesh_checks.hpp"

namespace tessera::io::testing {
namespace {

glm::dvec3 bent_place(CellSpace space, const glm::dvec3& p) {
  const double r = p.x, s = p.y, t = p.z;
  glm::dvec3 at(2 * r + 0.1 * s, 0.2 * r + 1.5 * s + 0.1 * t, 0.3 * s + t);
  if (space == CellSpace::linear) return at;
  at += glm::dvec3(0.3 * s * s + 0.1 * r * t, 0.15 * r * r - 0.1 * r * s, 0.12 * r * r + 0.08 * s * t);
  if (space == CellSpace::quadratic) at += glm::dvec3(0.1 * t * t, 0.2 * t * t, -0.05 * t * t);
  return at;
}

double field_of_place(CellSpace space, const glm::dvec3& p) {
  const double r = p.x, s = p.y, t = p.z;
  double value = 1 + r - 2 * s + 3 * t;
  if (space != CellSpace::linear) value += 1.5 * r * s - s * t + 0.4 * r * r;
  if (space == CellSpace::quadratic) value += 2 * t * t;
  return value;
}

/// The integral over a shape by Gauss's rule on the cube that collapses to it.
double integral_of(cells::CurvedFamily shape, const std::function<double(const glm::dvec3&)>& density) {
  static constexpr std::array<std::pair<double, double>, 5> rule = {{{0.0, 0.5688888888888889},
                                                                     {-0.5384693101056831, 0.47862867049936647},
                                                                     {0.5384693101056831, 0.47862867049936647},
                                                                     {-0.906179845938664, 0.23692688505618908},
                                                                     {0.906179845938664, 0.23692688505618908}}};
  double sum = 0;
  for (const auto& [a, wa] : rule)
    for (const auto& [b, wb] : rule)
      for (const auto& [c, wc] : rule) {
        const double u = (1 + a) / 2, v = (1 + b) / 2, w = (1 + c) / 2;
        glm::dvec3 p(u, v, w);
        double factor = 1;
        if (shape == cells::CurvedFamily::wedge) p = {u * (1 - v), v, w}, factor = 1 - v;
        if (shape == cells::CurvedFamily::tet)
          p = {u * (1 - v) * (1 - w), v * (1 - w), w}, factor = (1 - v) * (1 - w) * (1 - w);
        if (shape == cells::CurvedFamily::pyramid) p = {u * (1 - w), v * (1 - w), w}, factor = (1 - w) * (1 - w);
        sum += wa * wb * wc / 8 * factor * density(p);
      }
  return sum;
}

}  // namespace

std::vector<glm::dvec3> places_of(const ReferenceCell& cell) {
  std::vector<glm::dvec3> places;
  for (const cells::LatticePlace& corner : cells::corners_of(cell.shape))
    places.emplace_back(corner[0], corner[1], corner[2]);
  for (const std::vector<int>& middle : cell.middles) {
    glm::dvec3 sum(0);
    for (const int corner : middle) sum += places[static_cast<std::size_t>(corner) - 1];
    // A pyramid's inner node is half as high as the middle of its axis.
    places.push_back(middle.size() == 5 ? glm::dvec3(0.375, 0.375, 0.25) : sum / static_cast<double>(middle.size()));
  }
  return places;
}

std::vector<int> a_third(int from, int to) { return {from, from, to}; }

std::vector<int> near_first(const std::array<int, 4>& q) {
  return {q[0], q[0], q[0], q[0], q[1], q[1], q[2], q[3], q[3]};
}

std::vector<int> near_corner_of_hexahedron(int corner) {
  const auto corners = cells::corners_of(cells::CurvedFamily::hexahedron);
  const cells::LatticePlace& at = corners[static_cast<std::size_t>(corner) - 1];
  std::vector<int> list;
  for (std::size_t k = 0; k < 8; ++k) {
    int weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) weight *= corners[k][axis] == at[axis] ? 2 : 1;
    list.insert(list.end(), static_cast<std::size_t>(weight), static_cast<int>(k) + 1);
  }
  return list;
}

BentCell bend(const ReferenceCell& cell, bool mirrored) {
  std::vector<glm::dvec3> places = places_of(cell);
  if (mirrored)
    for (glm::dvec3& p : places) std::swap(p.x, p.y);
  return bend_places(cell.shape, cell.space, places);
}

BentCell bend_places(cells::CurvedFamily shape, CellSpace space, const std::vector<glm::dvec3>& places) {
  BentCell bent{};
  for (const glm::dvec3& p : places) {
    bent.positions.push_back(bent_place(space, p));
    bent.values.push_back(field_of_place(space, p));
  }
  const auto determinant = [&](const glm::dvec3& p) {
    constexpr double h = 1e-3;  // exact for polynomials of second degree
    const auto along = [&](const glm::dvec3& d) {
      return (bent_place(space, p + h * d) - bent_place(space, p - h * d)) / (2 * h);
    };
    return std::abs(glm::dot(glm::cross(along({1, 0, 0}), along({0, 1, 0})), along({0, 0, 1})));
  };
  bent.volume = integral_of(shape, determinant);
  bent.integral = integral_of(shape, [&](const glm::dvec3& p) { return determinant(p) * field_of_place(space, p); });
  return bent;
}

double field_integral(const scene::TetMesh& mesh) {
  double sum = 0;
  for (const scene::Tet& t : mesh.tets) {
    const glm::dvec3 a = mesh.positions[t[0]];
    const double six_volumes =
        std::abs(glm::dot(glm::cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a), mesh.positions[t[3]] - a));
    double values = 0;
    for (const std::uint32_t v : t) values += mesh.scalars[v];
    sum += six_volumes * values / 24;
  }
  return sum;
}

ReadOptions coarse_options() {
  ReadOptions options;
  options.field = "f";
  options.higher_order_tolerance = 2e-3;
  return options;
}

void expect_same(const cells::MeshFile& read, const BentCell& cell, double count) {
  // A misplaced node changes more than a hundredth; tets of the coarse tolerance less than half of that.
  EXPECT_NEAR(volume(read.mesh), count * cell.volume, 5e-3 * count * cell.volume);
  EXPECT_NEAR(field_integral(read.mesh), count * cell.integral, 5e-3 * count * std::abs(cell.integral));
  EXPECT_EQ(read.higher_order.by_corners, 0u);
}

}  // namespace tessera::io::testing
