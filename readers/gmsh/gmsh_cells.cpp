// SPDX-License-Identifier: BSD-3-Clause
#include "readers/gmsh/gmsh_cells.hpp"

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <numeric>
#include <optional>

#include "cells/curved/curved_lattice.hpp"

namespace tessera::readers {
namespace {

CellType linear_type(std::size_t corners) {
  return corners == 4   ? CellType::tetra
         : corners == 5 ? CellType::pyramid
         : corners == 6 ? CellType::wedge
                        : CellType::hexahedron;
}

/// Returns VTK's type for these numbers of corners and nodes; no value if there is none.
std::optional<CellType> curved_type(std::size_t order, std::size_t corners, std::size_t nodes) {
  const std::size_t n = order + 1;
  if (corners == 4 && nodes == 10) return CellType::quadratic_tetra;
  if (corners == 4 && nodes == n * (n + 1) * (n + 2) / 6) return CellType::lagrange_tetrahedron;
  if (corners == 5 && nodes == 13) return CellType::quadratic_pyramid;
  if (corners == 5 && nodes == n * (n + 1) * (2 * n + 1) / 6) return CellType::lagrange_pyramid;
  if (corners == 6 && nodes == 15) return CellType::quadratic_wedge;
  if (corners == 6 && nodes == 18) return CellType::biquadratic_quadratic_wedge;
  if (corners == 6 && nodes == n * n * (n + 1) / 2) return CellType::lagrange_wedge;
  if (corners == 8 && nodes == 20) return CellType::quadratic_hexahedron;
  if (corners == 8 && nodes == 27) return CellType::triquadratic_hexahedron;
  if (corners == 8 && nodes == n * n * n) return CellType::lagrange_hexahedron;
  return std::nullopt;
}

using Place = std::array<int, 3>;
using Places = std::vector<Place>;

Place step(const Place& from, const Place& to, int steps, int of) {
  Place p;
  for (std::size_t x = 0; x < 3; ++x) p[x] = from[x] + steps * (to[x] - from[x]) / of;
  return p;
}

void add_between(const Place& a, const Place& b, int order, Places& places) {
  for (int k = 1; k < order; ++k) places.push_back(step(a, b, k, order));
}

/// Adds the nodes of a triangle with `order` steps per edge: corners, edges around it, and the triangle inside.
void add_triangle(const Place& a, const Place& b, const Place& c, int order, Places& places) {
  places.push_back(a);
  if (order == 0) return;
  places.push_back(b), places.push_back(c);
  add_between(a, b, order, places), add_between(b, c, order, places), add_between(c, a, order, places);
  if (order < 3) return;
  const auto within = [&](const Place& p, const Place& q, const Place& r) {
    Place inner;
    for (std::size_t x = 0; x < 3; ++x) inner[x] = p[x] + (q[x] - p[x] + r[x] - p[x]) / order;
    return inner;
  };
  add_triangle(within(a, b, c), within(b, c, a), within(c, a, b), order - 3, places);
}

/// Adds the nodes of a quadrilateral in the same way.
void add_quadrilateral(const std::array<Place, 4>& c, int order, Places& places) {
  if (order < 0) return;
  places.push_back(c[0]);
  if (order == 0) return;
  places.insert(places.end(), c.begin() + 1, c.end());
  for (std::size_t k = 0; k < 4; ++k) add_between(c[k], c[(k + 1) % 4], order, places);
  std::array<Place, 4> inner;
  for (std::size_t k = 0; k < 4; ++k)
    for (std::size_t x = 0; x < 3; ++x)
      inner[k][x] = c[k][x] + (c[(k + 1) % 4][x] - c[k][x] + c[(k + 3) % 4][x] - c[k][x]) / order;
  add_quadrilateral(inner, order - 2, places);
}

}  // namespace

std::vector<double> gmsh_prism_places(int order) {
  const int n = order;
  const std::array<Place, 6> c = {{{0, 0, 0}, {n, 0, 0}, {0, n, 0}, {0, 0, n}, {n, 0, n}, {0, n, n}}};
  constexpr std::array<std::array<std::size_t, 2>, 9> edges = {
      {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}};
  Places places(c.begin(), c.end());
  for (const auto& [a, b] : edges) add_between(c[a], c[b], n, places);
  if (n >= 3) {
    add_triangle({1, 1, 0}, {1, n - 2, 0}, {n - 2, 1, 0}, n - 3, places);
    add_triangle({1, 1, n}, {n - 2, 1, n}, {1, n - 2, n}, n - 3, places);
  }
  const int m = n - 1;
  add_quadrilateral({{{1, 0, 1}, {m, 0, 1}, {m, 0, m}, {1, 0, m}}}, n - 2, places);
  add_quadrilateral({{{0, 1, 1}, {0, 1, m}, {0, m, m}, {0, m, 1}}}, n - 2, places);
  add_quadrilateral({{{m, 1, 1}, {1, m, 1}, {1, m, m}, {m, 1, m}}}, n - 2, places);
  if (n >= 3) {
    Places section;
    add_triangle({1, 1, 0}, {n - 2, 1, 0}, {1, n - 2, 0}, n - 3, section);
    for (const Place& p : section) {
      places.push_back({p[0], p[1], 1}), places.push_back({p[0], p[1], m});
      for (int k = 2; k < m; ++k) places.push_back({p[0], p[1], k});
    }
  }
  std::vector<double> numbers;
  for (const Place& p : places)
    for (std::size_t x = 0; x < 3; ++x) numbers.push_back(x < 2 ? static_cast<double>(p[x]) / n : 2.0 * p[x] / n - 1);
  return numbers;
}

GmshCell gmsh_cell(int order, std::size_t corners, std::span<const double> places) {
  const std::size_t nodes = places.size() / 3;
  GmshCell cell;
  cell.type = linear_type(corners);
  cell.nodes.resize(corners);
  std::iota(cell.nodes.begin(), cell.nodes.end(), std::size_t{0});
  if (nodes == corners) return cell;
  cell.by_corners = true;
  const std::optional<CellType> type = curved_type(static_cast<std::size_t>(order), corners, nodes);
  const std::optional<cells::CurvedLattice> lattice =
      type ? cells::curved_lattice(vtk_number(*type), nodes) : std::nullopt;
  if (!lattice) return cell;

  std::vector<glm::dvec3> theirs;
  for (std::size_t k = 0; k < nodes; ++k) {
    glm::dvec3 p(places[3 * k], places[3 * k + 1], places[3 * k + 2]);
    if (corners == 8) p = (p + 1.0) / 2.0;
    if (corners == 6) p.z = (p.z + 1) / 2;
    if (corners == 5) p = {(p.x + 1 - p.z) / 2, (p.y + 1 - p.z) / 2, p.z};
    theirs.push_back(p);
  }
  std::vector<std::size_t> order_of_nodes;
  for (std::size_t wanted = 0; wanted < nodes; ++wanted)
    for (std::size_t k = 0; k < nodes; ++k) {
      const glm::dvec3 d = theirs[k] - lattice->place(wanted);
      constexpr double apart = 1e-6;  // tolerance: nodes of order 100 are 1e-2 apart
      if (std::abs(d.x) + std::abs(d.y) + std::abs(d.z) < apart) order_of_nodes.push_back(k);
    }
  if (order_of_nodes.size() != nodes) return cell;
  cell.type = *type;
  cell.nodes = std::move(order_of_nodes);
  cell.by_corners = false;
  return cell;
}

}  // namespace tessera::readers
