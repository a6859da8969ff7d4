// SPDX-License-Identifier: BSD-3-Clause
#include "support/curved_meshes.hpp"

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <random>

namespace tessera::io::testing {

using scene::Association;

namespace {

std::size_t lagrange_nodes(std::uint8_t type, const std::array<int, 3>& n) {
  const auto p = static_cast<std::size_t>(n[0]) + 1, q = static_cast<std::size_t>(n[1]) + 1,
             m = static_cast<std::size_t>(n[2]) + 1;
  return type % 7 == 1 ? p * (p + 1) * (p + 2) / 6 : type % 7 == 2 ? p * q * m : p * (p + 1) / 2 * m;
}

Kind lagrange(std::uint8_t type, std::array<int, 3> n) {
  return {type, lagrange_nodes(type, n), type > 74 ? 1 : std::min({n[0], n[1], n[2]}), n};
}

}  // namespace

const std::vector<Kind> kinds = {{24, 10, 2},
                                 {25, 20, 2},
                                 {26, 15, 2},
                                 {27, 13, 1},
                                 {29, 27, 2},
                                 {31, 12, 1},
                                 {32, 18, 2},
                                 {33, 24, 2},
                                 {37, 19, 2},
                                 {71, 15, 2},
                                 {73, 21, 2},
                                 {71, 5, 1},
                                 {71, 8, 1},
                                 {71, 11, 2},
                                 {71, 14, 2},
                                 {72, 9, 1},
                                 {72, 16, 1},
                                 {72, 21, 2},
                                 {72, 26, 2},
                                 {73, 16, 2},
                                 {73, 20, 2},
                                 {74, 18, 2},
                                 {71, 16, 2},
                                 {72, 32, 3},
                                 {72, 56, 3},
                                 {73, 24, 2},
                                 {73, 38, 2},
                                 {74, 21, 2},
                                 {74, 29, 2},
                                 lagrange(71, {2, 2, 2}),
                                 lagrange(71, {3, 3, 3}),
                                 lagrange(71, {5, 5, 5}),
                                 lagrange(72, {2, 2, 2}),
                                 lagrange(72, {3, 2, 1}),
                                 lagrange(72, {3, 3, 3}),
                                 lagrange(73, {3, 3, 2}),
                                 lagrange(73, {4, 4, 4}),
                                 {74, 14, 2},
                                 {74, 30, 3},
                                 {74, 55, 4},
                                 lagrange(78, {2, 2, 2}),
                                 lagrange(78, {4, 4, 4}),
                                 lagrange(79, {3, 2, 1}),
                                 lagrange(79, {3, 3, 3}),
                                 lagrange(80, {3, 3, 2})};

glm::dvec3 place_of(const cells::CurvedLattice& lattice, std::size_t node) { return lattice.place(node); }

cells::CellBlock warped_box(const Kind& kind, int n, const Warp& warp, const Field& field, bool turned) {
  cells::CellBlock block;
  block.offsets = {0};
  std::vector<double> values, degrees;
  const auto lattice = cells::curved_lattice(kind.type, kind.nodes, kind.degrees);
  std::mt19937 random(7);
  const auto add = [&](const std::function<glm::dvec3(const glm::dvec3&)>& to_box) {
    for (std::size_t k = 0; k < kind.nodes; ++k) {
      glm::dvec3 p = to_box(place_of(*lattice, k));
      for (int x = 0; x < 3; ++x) p[x] = std::round(p[x] * 360360) / 360360;  // one point for all cells that share it
      p = warp(p);
      block.connectivity.push_back(static_cast<std::uint32_t>(block.positions.size()));
      block.positions.push_back(p);
      values.push_back(field(p));
    }
    block.types.push_back(kind.type);
    block.offsets.push_back(block.connectivity.size());
    for (const int d : kind.degrees) degrees.push_back(d);
  };
  static constexpr int kuhn[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int c = 0; c < n * n * n; ++c) {
    const glm::dvec3 from = glm::dvec3(c % n, c / n % n, c / (n * n)) / static_cast<double>(n);
    const double h = 1.0 / n;
    switch (lattice->family) {
      case cells::CurvedFamily::tet:
        for (const auto& axis : kuhn) {
          std::array<glm::dvec3, 4> corner = {from, from, from, from};
          for (int k = 0; k < 3; ++k)
            for (int after = k + 1; after < 4; ++after) corner[static_cast<std::size_t>(after)][axis[k]] += h;
          if (turned) std::shuffle(corner.begin(), corner.end(), random);
          add([=](const glm::dvec3& x) {
            return corner[0] * (1 - x.x - x.y - x.z) + corner[1] * x.x + corner[2] * x.y + corner[3] * x.z;
          });
        }
        break;
      case cells::CurvedFamily::hexahedron: {
        // Not all sides of a 24-node hexahedron have nodes in their middles, nor all edges of a 16-node one, and axes
        // of different order cannot be exchanged.
        const bool may_turn = turned && kind.type != 33 && kind.nodes != 16 && kind.degrees[0] == kind.degrees[2];
        const int turn = may_turn ? static_cast<int>(random() % 3) : 0;
        const bool flip = turned && random() % 2 == 0;
        add([=](const glm::dvec3& x) {
          glm::dvec3 y(x[turn % 3], x[(turn + 1) % 3], x[(turn + 2) % 3]);
          if (flip) y = glm::dvec3(1 - y.x, 1 - y.y, y.z);
          return from + h * y;
        });
        break;
      }
      case cells::CurvedFamily::wedge:
        for (const bool upper : {false, true}) {
          std::array<glm::dvec2, 3> corner = {glm::dvec2(0, 0), glm::dvec2(1, upper ? 1 : 0),
                                              glm::dvec2(upper ? 0 : 1, 1)};
          if (turned) std::rotate(corner.begin(), corner.begin() + static_cast<int>(random() % 3), corner.end());
          add([=](const glm::dvec3& x) {
            const glm::dvec2 y = corner[0] * (1 - x.x - x.y) + corner[1] * x.x + corner[2] * x.y;
            return from + h * glm::dvec3(y.x, y.y, x.z);
          });
        }
        break;
      case cells::CurvedFamily::pyramid:
        for (int side = 0; side < 6; ++side)  // the base is on a side of the cube, the apex in the cube's middle
          add([=](const glm::dvec3& x) {
            const double u = x.x + x.z / 2, v = x.y + x.z / 2, w = x.z / 2;
            const glm::dvec3 y = side < 3 ? glm::dvec3(u, v, w) : glm::dvec3(v, u, 1 - w);
            return from + h * glm::dvec3(y[side % 3], y[(side + 1) % 3], y[(side + 2) % 3]);
          });
        break;
    }
  }
  block.fields.push_back(cells::field_of_values("f", "double", Association::point, 1, std::move(values)));
  if (kind.degrees[0] > 0)
    block.fields.push_back(
        cells::field_of_values("HigherOrderDegrees", "double", Association::cell, 3, std::move(degrees)));
  return block;
}

glm::dvec3 bent(const glm::dvec3& p) {
  return {p.x + 0.05 * std::sin(3 * p.y + p.z), p.y + 0.05 * std::sin(2 * p.z + p.x), p.z + 0.05 * std::sin(4 * p.x)};
}

}  // namespace tessera::io::testing
