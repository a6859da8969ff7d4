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

/// What a higher-order cell looks like in its own coordinates (r, s, t), each 0 to 1. Corners are numbered as VTK's.
///
/// tet         r + s + t <= 1
/// hexahedron  the cube
/// wedge       r + s <= 1
/// pyramid     r and s <= 1 - t; not VTK's cube, so that its faces are the triangles of its neighbours
enum class CurvedFamily : std::uint8_t { tet, hexahedron, wedge, pyramid };

/// A place of the lattice on which a cell has nodes: node / order is its place in (r, s, t).
using LatticePlace = std::array<int, 3>;

/// So many steps of the lattice are from one place to another on an edge; at least 1.
inline int steps_between(const LatticePlace& p, const LatticePlace& q) {
  return std::max({1, std::abs(q[0] - p[0]), std::abs(q[1] - p[1]), std::abs(q[2] - p[2])});
}

/// The functions of a higher-order cell, by its lattice of nodes.
struct CurvedLattice {
  CurvedFamily family = CurvedFamily::tet;
  std::array<int, 3> order{};       ///< along r, s, t; one number for tets and pyramids, r and s alike for wedges
  std::vector<LatticePlace> nodes;  ///< of each of the cell's nodes, times `refined`; may be fewer than the lattice has
  std::size_t given = 0;            ///< cells have the first so many of them; the others follow from these
  int refined = 1;                  ///< so many steps of nodes' places are one of the lattice
  /// Quadratic cells that may have a node in the middle of a triangle too, and with it a cubic function, and one
  /// inside.
  bool has_bubbles = false;
  bool has_control_points = false;     ///< nodes are coefficients of Bernstein's polynomials (Bezier cells)
  std::vector<int> slot_of_place;      ///< where at(place) of cells' values is; -1: not of the lattice
  std::vector<int> slot_of_node;       ///< the same of each node; nodes that are not of the lattice come after it
  int slots = 0;                       ///< the lattice's places
  int all_slots = 0;                   ///< and of nodes that are not of it
  bool is_complete = true;             ///< each of them has a node
  std::vector<double> pyramid_matrix;  ///< pyramids: pyramid_matrix() of cells/curved/curved_pyramid.hpp

  [[nodiscard]] int slot(const LatticePlace& p) const {
    const auto at = [](int number) { return static_cast<std::size_t>(number); };
    return slot_of_place[(at(p[2]) * at(order[1] + 1) + at(p[1])) * at(order[0] + 1) + at(p[0])];
  }
  /// Of the node in the middle of a triangle, by its number among the cell's faces; -1 without one.
  std::array<int, 5> slot_of_middle = {-1, -1, -1, -1, -1};
  int slot_of_inside = -1;  ///< of a node inside that is not of the lattice; -1 without one
  /// A node's place in (r, s, t).
  [[nodiscard]] glm::dvec3 place(std::size_t node) const {
    const auto in_units = [&](std::size_t x) { return static_cast<double>(nodes[node][x]) / (refined * order[x]); };
    return {in_units(0), in_units(1), in_units(2)};
  }
};

inline constexpr int highest_pyramid_order = 8;

/// The lattice of a cell of one of VTK's types with so many nodes: 24 to 27, 29, 31, 32, 33, 37, Lagrange tetrahedra
/// (71; of 15 nodes too), hexahedra (72), wedges (73; of 21 nodes too) and pyramids (74), Bezier tetrahedra (78),
/// hexahedra (79) and wedges (80). `degrees` are those of VTK's HigherOrderDegrees, or zero: then hexahedra have one
/// order along all axes, and wedges as well; tetrahedra and pyramids do not look at them. Nothing if the number of
/// nodes is that of no such cell, or for other types.
///
/// Without degrees Lagrange's types are also the cells of second order that other formats have and VTK has not, whose
/// nodes are some of VTK's, in its order (c: centre, m: all faces' middles, t: triangles' middles, e: all edges):
/// tetrahedra of 5 (c), 7 (the base's edges), 8 (m), 11 (e c) and 14 (e m) nodes, hexahedra of 9 (c), 16 (edges of the
/// base and the top; linear along t), 21 (e c) and 26 (e m), wedges of 16 (e c) and 20 (e m), pyramids of 18 (e m).
/// What has no node is what the nodes of its edge or face make of it. So are CGNS's and Exodus' cells of third order
/// that have the first of VTK's nodes: tetrahedra of 16 (all edges), hexahedra of 32 (edges) and 56 (and faces), wedges
/// of 24 (edges) and 38 (and faces), pyramids of 21 (edges) and 29 (and faces).
///
/// Orders  Lagrange tetrahedra, hexahedra and wedges up to 100, pyramids up to 8, Bezier cells up to 12.
/// Nodes   in VTK's order (vtkQuadraticTetra.h ..., vtkHigherOrderTetra.h, vtkHigherOrderHexahedron.h,
///         vtkHigherOrderWedge.h of 9.1). VTK has no Lagrange pyramids yet. Ours have corners, edges (0 1, 1 2, 3 2, 0
///         3, 0 4, 1 4, 2 4, 3 4, each from the first), the base row by row along r, the triangles on the base's edges
///         in their order, row by row from the base up, each row as the edge runs, and layers of the inside from the
///         base up, row by row: of second order what its one way to go on from quadratic pyramids is.
std::optional<CurvedLattice> curved_lattice(std::uint8_t vtk_type, std::size_t nodes,
                                            const std::array<int, 3>& degrees = {});

/// A cell's corners in (r, s, t).
std::span<const LatticePlace> corners_of(CurvedFamily family);

std::span<const CellFace> faces_of(CurvedFamily family);

}  // namespace tessera::cells
