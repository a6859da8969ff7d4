// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "cells/cell_split.hpp"

namespace tessera::cells {

/// The shape of a higher-order cell in its own coordinates (r, s, t), each 0 to 1. Corners are numbered as in VTK.
///
/// tet         r + s + t <= 1
/// hexahedron  the cube
/// wedge       r + s <= 1
/// pyramid     r and s <= 1 - t; not VTK's cube, so that its faces are the triangles of its neighbours
enum class CurvedFamily : std::uint8_t { tet, hexahedron, wedge, pyramid };

/// A place on the lattice of a cell's nodes: its coordinates (r, s, t) are the place divided by the order.
using LatticePlace = std::array<int, 3>;

/// Returns the number of lattice steps from one place to another along an edge; at least 1.
inline int steps_between(const LatticePlace& p, const LatticePlace& q) {
  return std::max({1, std::abs(q[0] - p[0]), std::abs(q[1] - p[1]), std::abs(q[2] - p[2])});
}

/// The functions of a higher-order cell, defined by its lattice of nodes.
struct CurvedLattice {
  CurvedFamily family = CurvedFamily::tet;
  std::array<int, 3> order{};       ///< along r, s, t; all equal for tets and pyramids, r and s equal for wedges
  std::vector<LatticePlace> nodes;  ///< place of each node, in units of 1 / refined; may be fewer than the lattice has
  std::size_t given = 0;            ///< number of nodes that a cell stores; the others are computed from these
  int refined = 1;                  ///< number of units of `nodes` in one step of the lattice
  /// The cell is quadratic, but may also have nodes in the middle of triangles, with cubic functions, and one node
  /// inside.
  bool has_bubbles = false;
  bool has_control_points = false;     ///< nodes are coefficients of Bernstein polynomials, as in Bezier cells
  std::vector<int> slot_of_place;      ///< index of at(place) in the cell's values; -1: not on the lattice
  std::vector<int> slot_of_node;       ///< for each node, its index in the cell's values; nodes that are not on the
                                       ///< lattice follow those that are
  int slots = 0;                       ///< number of the lattice's places
  int all_slots = 0;                   ///< number of values, including those of nodes that are not on the lattice
  bool is_complete = true;             ///< every place of the lattice has a node
  std::vector<double> pyramid_matrix;  ///< for pyramids: pyramid_matrix() of cells/curved/curved_pyramid.hpp

  [[nodiscard]] int slot(const LatticePlace& p) const {
    const auto at = [](int number) { return static_cast<std::size_t>(number); };
    return slot_of_place[(at(p[2]) * at(order[1] + 1) + at(p[1])) * at(order[0] + 1) + at(p[0])];
  }
  /// For each face of the cell, the slot of the node in the middle if the face is a triangle; -1 if there is none.
  std::array<int, 5> slot_of_middle = {-1, -1, -1, -1, -1};
  int slot_of_inside = -1;  ///< slot of an inner node that is not on the lattice; -1 if there is none
  /// A node's coordinates (r, s, t).
  [[nodiscard]] glm::dvec3 place(std::size_t node) const {
    const auto in_units = [&](std::size_t x) { return static_cast<double>(nodes[node][x]) / (refined * order[x]); };
    return {in_units(0), in_units(1), in_units(2)};
  }
};

inline constexpr int highest_pyramid_order = 8;

/// Returns the lattice of a cell with one of VTK's types and this number of nodes: 24 to 27, 29, 31, 32, 33, 37,
/// Lagrange tetrahedra (71; also with 15 nodes), hexahedra (72), wedges (73; also with 21 nodes) and pyramids (74),
/// Bezier tetrahedra (78), hexahedra (79) and wedges (80). `degrees` are those of VTK's HigherOrderDegrees. If they are
/// zero, hexahedra and wedges have the same order along all axes. Tetrahedra and pyramids ignore them. No value for
/// other types, or if cells of the type cannot have this number of nodes.
///
/// Without degrees, Lagrange types also represent second-order cells of other formats that VTK does not have. Their
/// nodes are some of those of VTK's cells, in VTK's order (c: centre, m: all faces' middles, t: triangles' middles, e:
/// all edges): tetrahedra of 5 (c), 7 (the base's edges), 8 (m), 11 (e c) and 14 (e m) nodes, hexahedra of 9 (c), 16
/// (edges of the base and the top; linear along t), 21 (e c) and 26 (e m), wedges of 16 (e c) and 20 (e m), pyramids of
/// 18 (e m). Missing nodes are interpolated from the nodes of their edge or face. The same applies to third-order cells
/// of CGNS and Exodus that have only the first of VTK's nodes: tetrahedra of 16 (all edges), hexahedra of 32 (edges)
/// and 56 (and faces), wedges of 24 (edges) and 38 (and faces), pyramids of 21 (edges) and 29 (and faces).
///
/// Orders  Lagrange tetrahedra, hexahedra and wedges up to 100, pyramids up to 8, Bezier cells up to 12.
/// Nodes   are in VTK's order (vtkQuadraticTetra.h ..., vtkHigherOrderTetra.h, vtkHigherOrderHexahedron.h,
///         vtkHigherOrderWedge.h of 9.1). VTK does not have Lagrange pyramids yet. The order of ours is: corners, edges
///         (0 1, 1 2, 3 2, 0 3, 0 4, 1 4, 2 4, 3 4, each from the first corner), the base row by row along r, the
///         triangles on the base's edges in the order of these edges, row by row from the base up, each row in the
///         direction of the edge, and layers of the inside from the base up, row by row. For second order, the
///         first 13 nodes are in the order of VTK's quadratic pyramids, and the last one is the base's centre.
std::optional<CurvedLattice> curved_lattice(std::uint8_t vtk_type, std::size_t nodes,
                                            const std::array<int, 3>& degrees = {});

/// The corners of a cell in (r, s, t).
std::span<const LatticePlace> corners_of(CurvedFamily family);

std::span<const CellFace> faces_of(CurvedFamily family);

}  // namespace tessera::cells
