// SPDX-License-Identifier: BSD-3-Clause
// Computes the missing nodes of serendipity cells and cells of mixed order.
#include <array>
#include <cstddef>
#include <vector>

#include "cells/curved/curved_cell.hpp"

namespace tessera::cells {
namespace {

/// Transfinite interpolation at a place of a quadrilateral's or box's lattice from the values on its sides, which gives
/// the functions of serendipity cells. `node_at(place)` returns the value of a node.
template <std::size_t axes, class NodeAt>
glm::dvec4 between_sides(const std::array<int, axes>& place, const std::array<int, axes>& order,
                         const NodeAt& node_at) {
  glm::dvec4 sum(0);
  // Each coordinate is that of `place`, or the first or last one of its axis.
  for (int choices = 1; choices < (axes == 2 ? 9 : 27); ++choices) {
    std::array<int, axes> at = place;
    double weight = -1;
    int left = choices;
    for (std::size_t x = 0; x < axes; ++x, left /= 3) {
      if (left % 3 == 0) continue;
      const double u = static_cast<double>(place[x]) / order[x];
      at[x] = left % 3 == 1 ? 0 : order[x];
      weight *= left % 3 == 1 ? u - 1 : -u;
    }
    sum += weight * node_at(at);
  }
  return sum;
}

/// Returns the middle of a third-order triangle with nodes only on its edges. Reproduces all quadratic polynomials.
template <class NodeAt>
glm::dvec4 middle_of_cubic_triangle(const NodeAt& node_at) {
  const glm::dvec4 edges =
      node_at(1, 0) + node_at(2, 0) + node_at(2, 1) + node_at(1, 2) + node_at(0, 2) + node_at(0, 1);
  return edges / 4.0 - (node_at(0, 0) + node_at(3, 0) + node_at(0, 3)) / 6.0;
}

}  // namespace

/// For second order, the middles of edges are computed first; then, for second and third order, the nodes on faces and
/// inside.
void CurvedCell::add_missing_nodes() {
  std::vector<bool> given(values_.size(), false);
  for (std::size_t k = 0; k < lattice_->given; ++k) given[static_cast<std::size_t>(lattice_->slot_of_node[k])] = true;
  for (const CellFace& face : faces_of(lattice_->family)) {
    const auto size = static_cast<std::size_t>(face.size);
    for (std::size_t k = 0; k < size; ++k) {
      const LatticePlace a = lattice_corner(face.corner[k]), b = lattice_corner(face.corner[(k + 1) % size]);
      const LatticePlace between = {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
      if (lattice_->order[0] == 2 && !given[static_cast<std::size_t>(lattice_->slot(between))])
        node(between) = 0.5 * (node(a) + node(b));
    }
    add_missing_on(face, given);
  }
  add_missing_inside(given);
}

void CurvedCell::add_missing_on(const CellFace& face, const std::vector<bool>& given) {
  const auto [first, next, last] = first_corners(face);
  const LatticePlace a = lattice_corner(first), b = lattice_corner(next), c = lattice_corner(last);
  const std::array<int, 2> order = {steps_between(a, b), steps_between(a, c)};
  const auto place = [&](int i, int j) {
    LatticePlace p;
    for (std::size_t x = 0; x < 3; ++x) p[x] = a[x] + i * (b[x] - a[x]) / order[0] + j * (c[x] - a[x]) / order[1];
    return p;
  };
  const auto is_given = [&](int i, int j) { return given[static_cast<std::size_t>(lattice_->slot(place(i, j)))]; };
  if (face.size == 3) {
    if (order[0] == 3 && !is_given(1, 1))
      node(place(1, 1)) = middle_of_cubic_triangle([&](int i, int j) { return node(place(i, j)); });
    return;
  }
  const auto node_at = [&](const std::array<int, 2>& at) { return node(place(at[0], at[1])); };
  for (int j = 1; j < order[1]; ++j)
    for (int i = 1; i < order[0]; ++i)
      if (!is_given(i, j)) node(place(i, j)) = between_sides<2>({i, j}, order, node_at);
}

void CurvedCell::add_missing_inside(const std::vector<bool>& given) {
  const auto& n = lattice_->order;
  const auto is_given = [&](const LatticePlace& p) { return given[static_cast<std::size_t>(lattice_->slot(p))]; };
  if (lattice_->family == CurvedFamily::hexahedron) {
    const auto node_at = [&](const LatticePlace& p) { return node(p); };
    for (int k = 1; k < n[2]; ++k)
      for (int j = 1; j < n[1]; ++j)
        for (int i = 1; i < n[0]; ++i)
          if (!is_given({i, j, k})) node({i, j, k}) = between_sides<3>({i, j, k}, n, node_at);
  } else if (lattice_->family == CurvedFamily::wedge && n[0] == 3 && !is_given({1, 1, 1})) {
    const auto middle = [&](int k) { return middle_of_cubic_triangle([&](int i, int j) { return node({i, j, k}); }); };
    const glm::dvec4 base = node({1, 1, 0}) - middle(0), top = node({1, 1, 3}) - middle(3);
    for (int k = 1; k < 3; ++k) node({1, 1, k}) = middle(k) + base + k / 3.0 * (top - base);
  } else if (lattice_->family == CurvedFamily::pyramid && n[0] == 3 && !is_given({1, 1, 1})) {
    node({1, 1, 1}) = between_sides<2>({1, 1}, {2, 2}, [&](const std::array<int, 2>& p) {
      return node({p[0], p[1], 1});
    });
  }
}

}  // namespace tessera::cells
