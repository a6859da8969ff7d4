// SPDX-License-Identifier: BSD-3-Clause
#include "cells/curved/curved_lattice.hpp"

#include <algorithm>
#include <cmath>

#include "cells/curved/bernstein.hpp"
#include "cells/curved/curved_pyramid.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {
namespace {

constexpr LatticePlace tet_corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
constexpr LatticePlace hexahedron_corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                               {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
constexpr LatticePlace wedge_corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
constexpr LatticePlace pyramid_corners[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}};

using Edge = std::array<int, 2>;
constexpr Edge tet_edges[] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
constexpr Edge hexahedron_edges[] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6},
                                     {7, 6}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
constexpr Edge wedge_edges[] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
constexpr Edge pyramid_edges[] = {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}};

LatticePlace scaled(const LatticePlace& corner, const std::array<int, 3>& order) {
  return {corner[0] * order[0], corner[1] * order[1], corner[2] * order[2]};
}

/// Adds nodes to a lattice in VTK's order.
class Numbering {
 public:
  explicit Numbering(CurvedLattice& lattice) : lattice_(lattice) {
    for (const LatticePlace& corner : corners_of(lattice.family)) corners_.push_back(scaled(corner, lattice.order));
  }

  void add(const LatticePlace& place) { lattice_.nodes.push_back(place); }
  void add_corners() {
    for (const LatticePlace& corner : corners_) add(corner);
  }

  /// Adds the nodes between the ends of an edge, from the first end on.
  void add_edge(const Edge& edge) {
    const LatticePlace &a = corners_[static_cast<std::size_t>(edge[0])],
                       &b = corners_[static_cast<std::size_t>(edge[1])];
    const int n = std::max({std::abs(b[0] - a[0]), std::abs(b[1] - a[1]), std::abs(b[2] - a[2])});
    for (int k = 1; k < n; ++k)
      add({a[0] + k * (b[0] - a[0]) / n, a[1] + k * (b[1] - a[1]) / n, a[2] + k * (b[2] - a[2]) / n});
  }
  void add_edges(std::span<const Edge> edges) {
    for (const Edge& edge : edges) add_edge(edge);
  }

 private:
  CurvedLattice& lattice_;
  std::vector<LatticePlace> corners_;
};

/// Returns a + u (b - a) / n + v (c - a) / n.
LatticePlace between(const LatticePlace& a, const LatticePlace& b, const LatticePlace& c, int u, int v, int n) {
  LatticePlace p;
  for (std::size_t x = 0; x < 3; ++x) p[x] = a[x] + (u * (b[x] - a[x]) + v * (c[x] - a[x])) / n;
  return p;
}

/// Adds the nodes of a triangle of order n: corners and edges, then recursively the triangle inside.
void add_triangle(Numbering& numbering, const LatticePlace& a, const LatticePlace& b, const LatticePlace& c, int n) {
  const auto at = [&](int u, int v) { numbering.add(between(a, b, c, u, v, n)); };
  if (n == 0) return numbering.add(a);
  numbering.add(a), numbering.add(b), numbering.add(c);
  for (int k = 1; k < n; ++k) at(k, 0);
  for (int k = 1; k < n; ++k) at(n - k, k);
  for (int k = 1; k < n; ++k) at(0, n - k);
  if (n >= 3)
    add_triangle(numbering, between(a, b, c, 1, 1, n), between(a, b, c, n - 2, 1, n), between(a, b, c, 1, n - 2, n),
                 n - 3);
}

/// Adds the nodes of a tetrahedron with its corner at `from` and edges of n places along the axes.
void add_tet(Numbering& numbering, const LatticePlace& from, int n) {
  const LatticePlace corner[] = {
      from, {from[0] + n, from[1], from[2]}, {from[0], from[1] + n, from[2]}, {from[0], from[1], from[2] + n}};
  if (n == 0) return numbering.add(from);
  for (const LatticePlace& p : corner) numbering.add(p);
  for (const Edge& edge : tet_edges)
    for (int k = 1; k < n; ++k) {
      const LatticePlace &a = corner[edge[0]], &b = corner[edge[1]];
      numbering.add(between(a, b, a, k, 0, n));
    }
  static constexpr int faces[4][3] = {{0, 1, 3}, {2, 3, 1}, {0, 3, 2}, {0, 2, 1}};
  for (const auto& face : faces) {
    const LatticePlace &a = corner[face[0]], &b = corner[face[1]], &c = corner[face[2]];
    if (n >= 3)
      add_triangle(numbering, between(a, b, c, 1, 1, n), between(a, b, c, n - 2, 1, n), between(a, b, c, 1, n - 2, n),
                   n - 3);
  }
  if (n >= 4) add_tet(numbering, {from[0] + 1, from[1] + 1, from[2] + 1}, n - 4);
}

void number_lagrange_hexahedron(CurvedLattice& lattice) {
  const auto [p, q, n] = lattice.order;
  Numbering numbering(lattice);
  numbering.add_corners();
  numbering.add_edges(hexahedron_edges);
  for (const int i : {0, p})
    for (int k = 1; k < n; ++k)
      for (int j = 1; j < q; ++j) numbering.add({i, j, k});
  for (const int j : {0, q})
    for (int k = 1; k < n; ++k)
      for (int i = 1; i < p; ++i) numbering.add({i, j, k});
  for (const int k : {0, n})
    for (int j = 1; j < q; ++j)
      for (int i = 1; i < p; ++i) numbering.add({i, j, k});
  for (int k = 1; k < n; ++k)
    for (int j = 1; j < q; ++j)
      for (int i = 1; i < p; ++i) numbering.add({i, j, k});
}

void number_lagrange_wedge(CurvedLattice& lattice) {
  const int p = lattice.order[0], n = lattice.order[2];
  Numbering numbering(lattice);
  numbering.add_corners();
  numbering.add_edges(wedge_edges);
  const auto add_triangle_inside = [&](int k) {
    for (int j = 1; j < p; ++j)
      for (int i = 1; i + j < p; ++i) numbering.add({i, j, k});
  };
  add_triangle_inside(0);
  add_triangle_inside(n);
  for (int k = 1; k < n; ++k)
    for (int i = 1; i < p; ++i) numbering.add({i, 0, k});
  for (int k = 1; k < n; ++k)
    for (int j = 1; j < p; ++j) numbering.add({p - j, j, k});
  for (int k = 1; k < n; ++k)
    for (int j = p - 1; j > 0; --j) numbering.add({0, j, k});
  for (int k = 1; k < n; ++k) add_triangle_inside(k);
}

void number_lagrange_pyramid(CurvedLattice& lattice) {
  const int n = lattice.order[0];
  Numbering numbering(lattice);
  numbering.add_corners();
  numbering.add_edges(pyramid_edges);
  const auto add_layer = [&](int k) {
    for (int j = 1; j < n - k; ++j)
      for (int i = 1; i < n - k; ++i) numbering.add({i, j, k});
  };
  add_layer(0);
  for (int side = 0; side < 4; ++side)
    for (int k = 1; k < n; ++k)
      for (int i = 1; i < n - k; ++i) {
        const int far = n - k;
        numbering.add(side % 2 == 0 ? LatticePlace{i, side == 0 ? 0 : far, k}
                                    : LatticePlace{side == 1 ? far : 0, i, k});
      }
  for (int k = 1; k < n; ++k) add_layer(k);
}

bool is_of_lattice(const CurvedLattice& lattice, const LatticePlace& p) {
  switch (lattice.family) {
    case CurvedFamily::tet:
      return p[0] + p[1] + p[2] <= lattice.order[0];
    case CurvedFamily::hexahedron:
      return true;
    case CurvedFamily::wedge:
      return p[0] + p[1] <= lattice.order[0];
    case CurvedFamily::pyramid:
      return p[0] + p[2] <= lattice.order[0] && p[1] + p[2] <= lattice.order[0];
  }
  return false;
}

void number_slots(CurvedLattice& lattice) {
  const auto& n = lattice.order;
  const auto places_along = [&](std::size_t axis) { return static_cast<std::size_t>(n[axis]) + 1; };
  lattice.slot_of_place.assign(places_along(0) * places_along(1) * places_along(2), -1);
  std::size_t at = 0;
  for (int k = 0; k <= n[2]; ++k)
    for (int j = 0; j <= n[1]; ++j)
      for (int i = 0; i <= n[0]; ++i, ++at)
        if (is_of_lattice(lattice, {i, j, k})) lattice.slot_of_place[at] = lattice.slots++;
}

/// Returns the index of the triangle whose middle is this place; no value for other places.
std::optional<std::size_t> triangle_with_middle(const CurvedLattice& lattice, const LatticePlace& place) {
  const auto faces = faces_of(lattice.family);
  const auto corners = corners_of(lattice.family);
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (faces[f].size != 3) continue;
    bool is_middle = true;
    for (std::size_t x = 0; x < 3; ++x) {
      int sum = 0;
      for (std::size_t k = 0; k < 3; ++k) sum += corners[faces[f].corner[k]][x] * lattice.order[x] * lattice.refined;
      is_middle = is_middle && 3 * place[x] == sum;
    }
    if (is_middle) return f;
  }
  return std::nullopt;
}

/// Numbers the slots of the nodes; nodes outside the lattice keep their own order.
void number_nodes(CurvedLattice& lattice) {
  int beside = lattice.slots, of_lattice = 0;
  for (std::size_t k = 0; k < lattice.nodes.size(); ++k) {
    const LatticePlace& p = lattice.nodes[k];
    const int m = lattice.refined;
    if (p[0] % m == 0 && p[1] % m == 0 && p[2] % m == 0) {
      lattice.slot_of_node.push_back(lattice.slot({p[0] / m, p[1] / m, p[2] / m}));
      of_lattice += k < lattice.given ? 1 : 0;
      continue;
    }
    const std::optional<std::size_t> face = triangle_with_middle(lattice, p);
    (face ? lattice.slot_of_middle[*face] : lattice.slot_of_inside) = beside;
    lattice.slot_of_node.push_back(beside++);
  }
  lattice.all_slots = beside;
  lattice.is_complete = of_lattice == lattice.slots;
}

/// Returns the n for which nodes_of(n) is `nodes`; 0 if there is none.
template <class NodesOf>
int order_with(std::size_t nodes, const NodesOf& nodes_of) {
  for (std::size_t n = 1; nodes_of(n) <= nodes; ++n)
    if (nodes_of(n) == nodes) return static_cast<int>(n);
  return 0;
}

CurvedLattice quadratic(CurvedFamily family, int order_t = 2) {
  CurvedLattice lattice;
  lattice.family = family;
  lattice.order = {2, 2, order_t};
  return lattice;
}

/// Returns the lattice of quadratic cells with a node in the middle of each triangle and, for tets and pyramids, of the
/// cell.
CurvedLattice bubble_lattice(CurvedFamily family) {
  CurvedLattice lattice = quadratic(family);
  lattice.has_bubbles = true;
  lattice.refined = family == CurvedFamily::pyramid ? 12 : 6;  // a multiple of 2 and 3, for pyramids also of 4
  Numbering numbering(lattice);
  numbering.add_corners();
  const auto refine = [&] {
    for (LatticePlace& p : lattice.nodes)
      for (int& number : p) number *= lattice.refined;
  };
  switch (family) {
    case CurvedFamily::tet:
      numbering.add_edges(tet_edges);
      refine();
      for (const LatticePlace& p : {LatticePlace{4, 4, 0}, {4, 0, 4}, {4, 4, 4}, {0, 4, 4}, {3, 3, 3}})
        numbering.add(p);
      break;
    case CurvedFamily::wedge:
      numbering.add_edges(wedge_edges);
      refine();
      for (const LatticePlace& p : {LatticePlace{4, 4, 0}, {4, 4, 12}, {6, 0, 6}, {6, 6, 6}, {0, 6, 6}, {4, 4, 6}})
        numbering.add(p);
      break;
    case CurvedFamily::pyramid:
      numbering.add_edges(pyramid_edges);
      numbering.add({1, 1, 0});
      refine();
      for (const LatticePlace& p : {LatticePlace{8, 0, 8}, {16, 8, 8}, {8, 16, 8}, {0, 8, 8}, {9, 9, 6}})
        numbering.add(p);
      break;
    case CurvedFamily::hexahedron:  // has no triangles
      break;
  }
  return lattice;
}

/// Returns the lattice of VTK's quadratic cells, whose mid-edge nodes follow another order of edges than those of VTK's
/// higher-order cells.
std::optional<CurvedLattice> quadratic_lattice(CellType type) {
  static constexpr Edge hexahedron_rounds[] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                               {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};
  static constexpr LatticePlace face_centres[] = {{0, 1, 1}, {2, 1, 1}, {1, 0, 1}, {1, 2, 1}, {1, 1, 0}, {1, 1, 2}};
  CurvedLattice lattice;
  switch (type) {
    case CellType::quadratic_hexahedron:
    case CellType::triquadratic_hexahedron:
    case CellType::biquadratic_quadratic_hexahedron: {
      lattice = quadratic(CurvedFamily::hexahedron);
      Numbering numbering(lattice);
      numbering.add_corners();
      numbering.add_edges(hexahedron_rounds);
      const int centres = type == CellType::quadratic_hexahedron               ? 0
                          : type == CellType::biquadratic_quadratic_hexahedron ? 4
                                                                               : 6;
      for (int k = 0; k < centres; ++k) numbering.add(face_centres[k]);
      if (type == CellType::triquadratic_hexahedron) numbering.add({1, 1, 1});
      return lattice;
    }
    case CellType::quadratic_wedge:
    case CellType::quadratic_linear_wedge:
    case CellType::biquadratic_quadratic_wedge: {
      lattice = quadratic(CurvedFamily::wedge, type == CellType::quadratic_linear_wedge ? 1 : 2);
      Numbering numbering(lattice);
      numbering.add_corners();
      numbering.add_edges(std::span(wedge_edges).first(type == CellType::quadratic_linear_wedge ? 6 : 9));
      if (type == CellType::biquadratic_quadratic_wedge)
        for (const LatticePlace& p : {LatticePlace{1, 0, 1}, {1, 1, 1}, {0, 1, 1}}) numbering.add(p);
      return lattice;
    }
    case CellType::quadratic_pyramid: {
      lattice = quadratic(CurvedFamily::pyramid);
      Numbering numbering(lattice);
      numbering.add_corners();
      numbering.add_edges(pyramid_edges);
      return lattice;
    }
    case CellType::triquadratic_pyramid:
      return bubble_lattice(CurvedFamily::pyramid);
    default:
      return std::nullopt;
  }
}

/// Returns the lattice of second-order cells that VTK does not have, which are identified by their numbers of nodes.
std::optional<CurvedLattice> incomplete_lattice(CellType type, std::size_t nodes) {
  struct Row {
    CellType type;
    std::size_t nodes;
    CurvedFamily family;
    std::size_t first, from, to;  ///< the cell has the first nodes of a complete cell, then those in [from, to)
  };
  static constexpr Row rows[] = {{CellType::lagrange_tetrahedron, 5, CurvedFamily::tet, 4, 14, 15},
                                 {CellType::lagrange_tetrahedron, 7, CurvedFamily::tet, 7, 0, 0},
                                 {CellType::lagrange_tetrahedron, 8, CurvedFamily::tet, 4, 10, 14},
                                 {CellType::lagrange_tetrahedron, 11, CurvedFamily::tet, 10, 14, 15},
                                 {CellType::lagrange_tetrahedron, 14, CurvedFamily::tet, 14, 0, 0},
                                 {CellType::lagrange_hexahedron, 9, CurvedFamily::hexahedron, 8, 26, 27},
                                 {CellType::lagrange_hexahedron, 16, CurvedFamily::hexahedron, 16, 0, 0},
                                 {CellType::lagrange_hexahedron, 21, CurvedFamily::hexahedron, 20, 26, 27},
                                 {CellType::lagrange_hexahedron, 26, CurvedFamily::hexahedron, 26, 0, 0},
                                 {CellType::lagrange_wedge, 16, CurvedFamily::wedge, 15, 20, 21},
                                 {CellType::lagrange_wedge, 20, CurvedFamily::wedge, 20, 0, 0},
                                 {CellType::lagrange_pyramid, 18, CurvedFamily::pyramid, 18, 0, 0}};
  for (const Row& row : rows) {
    if (row.type != type || row.nodes != nodes) continue;
    const bool is_hexahedron = row.family == CurvedFamily::hexahedron;
    CurvedLattice lattice =
        is_hexahedron ? *quadratic_lattice(CellType::triquadratic_hexahedron) : bubble_lattice(row.family);
    const std::vector<LatticePlace> all = lattice.nodes;
    lattice.nodes.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(row.first));
    lattice.nodes.insert(lattice.nodes.end(), all.begin() + static_cast<std::ptrdiff_t>(row.from),
                         all.begin() + static_cast<std::ptrdiff_t>(row.to));
    if (is_hexahedron && nodes == 16) {
      lattice.order[2] = 1;
      for (LatticePlace& p : lattice.nodes) p[2] /= 2;
    }
    return lattice;
  }
  return std::nullopt;
}

/// Lattice of Lagrange cells.
std::optional<CurvedLattice> lagrange_lattice(CellType type, std::size_t nodes, const std::array<int, 3>& degrees) {
  if (type == CellType::lagrange_tetrahedron && nodes == 15) return bubble_lattice(CurvedFamily::tet);
  if (type == CellType::lagrange_wedge && nodes == 21 && degrees[2] <= 2) return bubble_lattice(CurvedFamily::wedge);
  const bool given = degrees[0] > 0 && degrees[1] > 0 && degrees[2] > 0 &&
                     (type == CellType::lagrange_hexahedron || type == CellType::lagrange_wedge);
  constexpr int highest = 100;  // limit of the order, 10^6 nodes per cell
  if (given) {
    if (std::max({degrees[0], degrees[1], degrees[2]}) > highest) return std::nullopt;
    const std::size_t p = static_cast<std::size_t>(degrees[0]) + 1, q = static_cast<std::size_t>(degrees[1]) + 1,
                      n = static_cast<std::size_t>(degrees[2]) + 1;
    if (nodes != (type == CellType::lagrange_hexahedron ? p * q * n : p * (p + 1) / 2 * n)) return std::nullopt;
  }
  CurvedLattice lattice;
  if (type == CellType::quadratic_tetra || type == CellType::lagrange_tetrahedron) {
    const int n = order_with(nodes, [](std::size_t k) { return (k + 1) * (k + 2) * (k + 3) / 6; });
    lattice.family = CurvedFamily::tet;
    lattice.order = {n, n, n};
    Numbering numbering(lattice);
    if (n > 0 && n <= highest) add_tet(numbering, {0, 0, 0}, n);
  } else if (type == CellType::lagrange_hexahedron) {
    const int n = order_with(nodes, [](std::size_t k) { return (k + 1) * (k + 1) * (k + 1); });
    lattice.family = CurvedFamily::hexahedron;
    lattice.order = given ? degrees : std::array{n, n, n};
    if ((given || n > 0) && lattice.order[0] <= highest) number_lagrange_hexahedron(lattice);
  } else if (type == CellType::lagrange_wedge) {
    const int n = order_with(nodes, [](std::size_t k) { return (k + 1) * (k + 2) / 2 * (k + 1); });
    lattice.family = CurvedFamily::wedge;
    lattice.order = given ? std::array{degrees[0], degrees[0], degrees[2]} : std::array{n, n, n};
    if ((given || n > 0) && lattice.order[0] <= highest) number_lagrange_wedge(lattice);
  } else if (type == CellType::lagrange_pyramid) {
    const int n = order_with(nodes, [](std::size_t k) { return (k + 1) * (k + 2) * (2 * k + 3) / 6; });
    lattice.family = CurvedFamily::pyramid;
    lattice.order = {n, n, n};
    if (n > 0 && n <= highest_pyramid_order) number_lagrange_pyramid(lattice);
  }
  return lattice.nodes.empty() ? std::nullopt : std::optional(std::move(lattice));
}

/// Returns the lattice of third-order cells that have only the first nodes: those of edges, or of edges and faces.
std::optional<CurvedLattice> incomplete_cubic_lattice(CellType type, std::size_t nodes) {
  struct Row {
    CellType type;
    std::size_t nodes, all;
  };
  static constexpr Row rows[] = {{CellType::lagrange_tetrahedron, 16, 20}, {CellType::lagrange_hexahedron, 32, 64},
                                 {CellType::lagrange_hexahedron, 56, 64},  {CellType::lagrange_wedge, 24, 40},
                                 {CellType::lagrange_wedge, 38, 40},       {CellType::lagrange_pyramid, 21, 30},
                                 {CellType::lagrange_pyramid, 29, 30}};
  for (const Row& row : rows) {
    if (row.type != type || row.nodes != nodes) continue;
    std::optional<CurvedLattice> lattice = lagrange_lattice(type, row.all, {});
    lattice->given = nodes;
    return lattice;
  }
  return std::nullopt;
}

/// Returns the lattice of Bezier cells, which is that of Lagrange cells.
std::optional<CurvedLattice> bezier_lattice(CellType type, std::size_t nodes, const std::array<int, 3>& degrees) {
  if (type < CellType::bezier_tetrahedron || type > CellType::bezier_wedge) return std::nullopt;
  const CellType lagrange = type == CellType::bezier_tetrahedron  ? CellType::lagrange_tetrahedron
                            : type == CellType::bezier_hexahedron ? CellType::lagrange_hexahedron
                                                                  : CellType::lagrange_wedge;
  std::optional<CurvedLattice> lattice = lagrange_lattice(lagrange, nodes, degrees);
  if (!lattice || lattice->has_bubbles) return std::nullopt;
  if (std::max({lattice->order[0], lattice->order[1], lattice->order[2]}) > highest_degree) return std::nullopt;
  lattice->has_control_points = true;
  return lattice;
}

}  // namespace

std::optional<CurvedLattice> curved_lattice(std::uint8_t vtk_type, std::size_t nodes,
                                            const std::array<int, 3>& degrees) {
  const CellType type{vtk_type};
  std::optional<CurvedLattice> lattice = quadratic_lattice(type);
  if (!lattice && degrees == std::array<int, 3>{}) lattice = incomplete_lattice(type, nodes);
  if (!lattice && degrees == std::array<int, 3>{}) lattice = incomplete_cubic_lattice(type, nodes);
  if (!lattice) lattice = lagrange_lattice(type, nodes, degrees);
  if (!lattice) lattice = bezier_lattice(type, nodes, degrees);
  if (!lattice) return std::nullopt;
  if (lattice->given == 0) lattice->given = lattice->nodes.size();
  if (lattice->given != nodes) return std::nullopt;
  number_slots(*lattice);
  number_nodes(*lattice);
  if (lattice->family == CurvedFamily::pyramid) lattice->pyramid_matrix = pyramid_matrix(*lattice);
  return lattice;
}

std::span<const LatticePlace> corners_of(CurvedFamily family) {
  switch (family) {
    case CurvedFamily::tet:
      return tet_corners;
    case CurvedFamily::hexahedron:
      return hexahedron_corners;
    case CurvedFamily::wedge:
      return wedge_corners;
    case CurvedFamily::pyramid:
      return pyramid_corners;
  }
  return {};
}

std::span<const CellFace> faces_of(CurvedFamily family) {
  constexpr std::array kinds = {CellKind::tet, CellKind::hexahedron, CellKind::wedge, CellKind::pyramid};
  return faces_of(kinds[static_cast<std::size_t>(family)]);
}

}  // namespace tessera::cells
