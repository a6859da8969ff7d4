// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cells/curved/curved_lattice.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {

/// Formats whose higher-order cells have some node orders that differ from VTK's.
///
/// exodus  "Exodus: A Finite Element Data Model" (SEACAS), section on element types, whose figures follow Patran's
///         element library: the edges between base and top precede the top's, an inner node precedes those of faces.
///         The manual omits tetrahedra of 8 nodes and cells of third order; theirs are derived from the edges and sides
///         that the library returns (ex_get_side_set_node_list, and Ioss_Tet16, Wedge24, Hex32 and Hex64). Names may
///         vary, as for linear cells: `HEX`, `hex27`.
/// med     "MED File Format", reference elements (MED_TETRA4 ... MED_HEXA27). The corners of its cells have the
///         opposite orientation to VTK's, which mirrors the cell and changes no order; only faces' middles differ.
/// nastran "Quick Reference Guide", CTETRA, CPYRAM, CPENTA and CHEXA: the edges between base and top precede the top's.
///         Any mid-edge node may be blank.
/// cgns    SIDS, section 3.3 "Unstructured Grid Element Numbering Conventions". CGNS's own library reads cells of
///         higher order (readers/vtk/cgns_cells.hpp), because VTK 9.1's reader gets some of them wrong. Cells of fourth
///         order are not supported: SIDS places the nodes inside triangles elsewhere than on the lattice that exporters
///         use.
/// tetgen  User's manual, ".ele files": the edges of a tetrahedron of 10 nodes.
///
/// Already in VTK's order: EnSight (User Manual, EnSight Gold Geometry File Format; VTK's reader mirrors wedges), XDMF
/// (Tet_10 ... Hex_27, as written by VTK and meshio; the format's pages define no order), legacy VTK and VTK XML except
/// old Lagrange hexahedra (exchange_vtk8_edges() below), VTKHDF, Medit. For Gmsh's own files, the node positions
/// reported by its library determine the order (readers/gmsh/gmsh_cells.hpp). AVS UCD, Fluent, GAMBIT, OpenFOAM,
/// PLOT3D, SU2 and Tecplot have only linear cells here.
enum class NodeConvention : std::uint8_t { exodus, med, cgns, nastran, tetgen };

/// The node order of one cell type of a format. Shape and number of nodes identify the cell type.
struct NodeOrder {
  NodeConvention convention;
  CurvedFamily shape;
  std::uint8_t nodes;
  CellType type;  ///< a type of curved_lattice(), or a linear type
  /// For each of VTK's nodes, its index in the format's list, from 0. Empty if both orders are identical.
  std::span<const std::uint8_t> from;
};

/// Returns null for cells that the format does not have, or that are not divided here.
const NodeOrder* find_node_order(NodeConvention convention, CurvedFamily shape, std::size_t nodes);

/// Returns all node orders, for tests.
std::span<const NodeOrder> all_node_orders();

/// Reorders the nodes of one cell from the format's order to VTK's. `nodes` has as many entries as `order`.
void to_vtk_order(const NodeOrder& order, std::span<std::uint32_t> nodes);

/// The order of Exodus' tetrahedra of 15 nodes in the library's side sets and in Ioss: the inner node is last, while in
/// the manual it precedes the nodes of the faces. There are files with either order.
const NodeOrder& exodus_tet15_with_centre_last();

/// The order of Exodus' wedges of 21 nodes in Ioss_Wedge21: the nodes of the triangles precede the inner node. In the
/// manual and the library's side sets, the inner node is first.
const NodeOrder& exodus_wedge21_of_ioss();

/// In VTK 8 and in VTK XML files before version 2.1, the nodes of the last two edges of a Lagrange hexahedron are in
/// the opposite order (3-7 before 2-6). This function exchanges them, from either order to the other. `degrees` are
/// those of VTK's HigherOrderDegrees. If they are zero, the cell has one degree along all axes, and cells that do not
/// have (n + 1)^3 nodes are left unchanged.
void exchange_vtk8_edges(std::span<std::uint32_t> nodes, const std::array<int, 3>& degrees = {});
void exchange_vtk8_edges(std::span<long long> nodes, const std::array<int, 3>& degrees = {});  ///< vtkIdType

}  // namespace tessera::cells
