// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <string>
#include <vector>

#include "scene/tet_mesh.hpp"

namespace tessera::cells {

enum class CellKind : std::uint8_t {
  tet,
  voxel,
  hexahedron,
  wedge,
  pyramid,
  pentagonal_prism,
  hexagonal_prism,
  not_volumetric,
  unsupported,
  convex_point_set,
  polyhedron
};

/// Properties of one of VTK's cell types.
struct CellShape {
  CellKind kind = CellKind::unsupported;
  int corners = 0;            ///< number of nodes that are corners; these come first in the cell's list
  int nodes = 0;              ///< required number of nodes; 0: at least `corners` (Lagrange and Bezier cells)
  bool higher_order = false;  ///< the cell has more nodes than corners
};

/// Returns the properties of a cell type. For convex point sets and polyhedra, the numbers of corners and nodes vary
/// from cell to cell.
CellShape cell_shape(std::uint8_t vtk_type);

/// Returns VTK's name of a type for messages, for example "polyhedron"; "type 99" if the type has no name.
std::string cell_type_name(std::uint8_t vtk_type);

/// Splits one cell into tets and appends the tets to `tets`. Their corners are entries of `corner`, which contains the
/// cell's corners in VTK's order.
///
/// Neighbours agree on every shared face, because the split depends only on positions: each face is cut from its
/// lexicographically smallest corner (Dompierre, Labbe, Vallet, Camarero, "How to Subdivide Pyramids, Prisms, and
/// Hexahedra into Tetrahedra", 8th International Meshing Roundtable 1999, with position order instead of index order),
/// and the cell is the cone over those triangles from its own smallest corner. A warped face becomes its two triangles.
/// Coincident corners only cause flat triangles. So whichever of them counts as smallest, the triangles with an area
/// are the same from both sides. A hexahedron gives 5 tets if no cut of a face meets the corner opposite to the
/// smallest, else 6; a wedge gives 3, a pyramid 2, a pentagonal prism 9, a hexagonal prism 12. All tets of a convex
/// cell have the same orientation.
void split_cell(CellKind kind, std::span<const std::uint32_t> corner, std::span<const glm::dvec3> positions,
                std::vector<scene::Tet>& tets);

/// A face of a cell: the corners in order, oriented outward.
struct CellFace {
  int size;
  std::array<std::uint8_t, 6> corner;
};
/// Returns the faces of a tet, hexahedron, wedge, pyramid or prism, in VTK's corner numbers. The faces of a voxel are
/// those of a hexahedron. Empty for other kinds.
std::span<const CellFace> faces_of(CellKind kind);

/// Appends the faces of a cell: for each face the number of its corners, then the corners, which are entries of
/// `corner`. Appends nothing for a tet, a polyhedron and cells without volume.
void append_faces(CellKind kind, std::span<const std::uint32_t> corner, std::vector<std::uint32_t>& faces);

}  // namespace tessera::cells
