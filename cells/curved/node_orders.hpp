// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cells/curved/curved_lattice.hpp"
#include "tessera/cell_type.hpp"

namespace tessera::cells {

/// Formats whose cells of higher order have their nodes in another order than VTK's, in some types.
///
/// exodus  "Exodus: A Finite Element Data Model" (SEACAS), section on element types, whose figures follow Patran's
///         element library: the edges between base and top come before the top's, a node inside before those of faces.
///         The manual leaves out tetrahedra of 8 nodes and cells of third order; theirs are those of the edges and
///         sides that the library gives (ex_get_side_set_node_list, and Ioss_Tet16, Wedge24, Hex32 and Hex64). Names
///         are as free as corners: `HEX`, `hex27`.
/// med     "MED File Format", reference elements (MED_TETRA4 ... MED_HEXA27). The corners of its cells go round against
///         VTK's sense, which mirrors the cell and changes no order; only faces' middles come otherwise.
/// nastran "Quick Reference Guide", CTETRA, CPYRAM, CPENTA and CHEXA: the edges between base and top come before the
///         top's. Any node in the middle of an edge may be blank.
/// cgns    SIDS, section 3.3 "Unstructured Grid Element Numbering Conventions". Cells of higher order are read by
///         CGNS's own library (readers/vtk/cgns_cells.hpp), as VTK 9.1's reader gets some of them wrong. Those of
///         fourth order are not: SIDS places the nodes inside triangles elsewhere than on the lattice that exporters
///         take.
/// tetgen  User's manual, ".ele files": the edges of a tetrahedron of 10 nodes.
///
/// In VTK's order as they are: EnSight (User Manual, EnSight Gold Geometry File Format; VTK's reader mirrors wedges),
/// XDMF (Tet_10 ... Hex_27, which VTK and meshio write so; the format's pages define none), legacy VTK and VTK XML but
/// for old Lagrange hexahedra (exchange_vtk8_edges() below), VTKHDF, Medit. Gmsh's own files go by the
/// places of nodes that its library gives (readers/gmsh/gmsh_cells.hpp). AVS UCD, Fluent,
/// GAMBIT, OpenFOAM, PLOT3D, SU2 and Tecplot have linear cells here.
enum class NodeConvention : std::uint8_t { exodus, med, cgns, nastran, tetgen };

/// One cell type of a format, told by its shape and its number of nodes.
struct NodeOrder {
  NodeConvention convention;
  CurvedFamily shape;
  std::uint8_t nodes;
  CellType type;  ///< as curved_lattice() has it, or a linear one
  /// Of each of VTK's nodes the number in the format's list, from 0; empty: its own.
  std::span<const std::uint8_t> from;
};

/// Null for cells that the format has not, or that are not divided here.
const NodeOrder* find_node_order(NodeConvention convention, CurvedFamily shape, std::size_t nodes);

/// All rows, for tests.
std::span<const NodeOrder> all_node_orders();

/// Puts one cell's nodes from the format's order into VTK's. `nodes` has as many as the row.
void to_vtk_order(const NodeOrder& order, std::span<std::uint32_t> nodes);

/// Exodus' tetrahedra of 15 nodes as the library's side sets and Ioss have them: the node inside comes last, not before
/// those of the faces as in the manual. Files have both.
const NodeOrder& exodus_tet15_with_centre_last();

/// Exodus' wedges of 21 nodes as Ioss_Wedge21 has their faces: those of the triangles come before the node inside. The
/// manual and the library's side sets have that first.
const NodeOrder& exodus_wedge21_of_ioss();

/// VTK 8 and files of VTK XML before version 2.1 have the nodes of the last two of a Lagrange hexahedron's edges the
/// other way round (3-7 before 2-6). Exchanges them, from the one to the other; `degrees` are those of VTK's
/// HigherOrderDegrees, or zero: then one along all axes, and cells that have not (n + 1)^3 nodes are left alone.
void exchange_vtk8_edges(std::span<std::uint32_t> nodes, const std::array<int, 3>& degrees = {});
void exchange_vtk8_edges(std::span<long long> nodes, const std::array<int, 3>& degrees = {});  ///< of vtkIdType

}  // namespace tessera::cells
