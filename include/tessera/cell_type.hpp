// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera {
inline namespace v0_1 {

/// The type of a mesh's cell (MeshArrays::types). Names, values and the order of the points are those of VTK
/// (vtkCellType.h), so an array of VTK's numbers can be passed unchanged. The comment of each type gives its number of
/// points; n is the order of the cell, at least 1.
///
/// Cells without volume are left out of the mesh. VTK's other types of cells with a volume cause an error that contains
/// the number of the cell.
enum class CellType : std::uint8_t {
  // Linear cells.
  tetra = 10,             ///< 4
  voxel = 11,             ///< 8, x fastest, then y, then z
  hexahedron = 12,        ///< 8
  wedge = 13,             ///< 6
  pyramid = 14,           ///< 5
  pentagonal_prism = 15,  ///< 10
  hexagonal_prism = 16,   ///< 12
  convex_point_set = 41,  ///< any number; the cell is the convex hull of its points
  polyhedron = 42,        ///< any number; the cell is given by its faces (MeshArrays::faces)

  // Cells of second order: corners first, then the middles of edges, faces and the cell.
  quadratic_tetra = 24,                   ///< 10
  quadratic_hexahedron = 25,              ///< 20
  quadratic_wedge = 26,                   ///< 15
  quadratic_pyramid = 27,                 ///< 13
  triquadratic_hexahedron = 29,           ///< 27
  quadratic_linear_wedge = 31,            ///< 12
  biquadratic_quadratic_wedge = 32,       ///< 18
  biquadratic_quadratic_hexahedron = 33,  ///< 24
  triquadratic_pyramid = 37,              ///< 19

  // Cells of any order, which is the same along all axes. A cell with another number of points than those listed is
  // drawn as a linear cell between its corners.
  lagrange_tetrahedron = 71,  ///< (n + 1) (n + 2) (n + 3) / 6, n up to 100; or 5, 7, 8, 11, 14, 15, 16
  lagrange_hexahedron = 72,   ///< (n + 1)^3, n up to 100; or 9, 16, 21, 26, 32, 56
  lagrange_wedge = 73,        ///< (n + 1)^2 (n + 2) / 2, n up to 100; or 16, 20, 21, 24, 38
  lagrange_pyramid = 74,      ///< (n + 1) (n + 2) (2 n + 3) / 6, n up to 8; or 18, 21, 29
  bezier_tetrahedron = 78,    ///< (n + 1) (n + 2) (n + 3) / 6, n up to 12
  bezier_hexahedron = 79,     ///< (n + 1)^3, n up to 12
  bezier_wedge = 80,          ///< (n + 1)^2 (n + 2) / 2, n up to 12
  bezier_pyramid = 81,        ///< at least 5; drawn as a linear cell between its corners

  // Cells without volume.
  empty_cell = 0,               ///< 0
  vertex = 1,                   ///< 1
  poly_vertex = 2,              ///< any number
  line = 3,                     ///< 2
  poly_line = 4,                ///< any number
  triangle = 5,                 ///< 3
  triangle_strip = 6,           ///< any number
  polygon = 7,                  ///< any number
  pixel = 8,                    ///< 4, x fastest, then y
  quad = 9,                     ///< 4
  quadratic_edge = 21,          ///< 3
  quadratic_triangle = 22,      ///< 6
  quadratic_quad = 23,          ///< 8
  biquadratic_quad = 28,        ///< 9
  quadratic_linear_quad = 30,   ///< 6
  biquadratic_triangle = 34,    ///< 7
  cubic_line = 35,              ///< 4
  quadratic_polygon = 36,       ///< any even number
  lagrange_curve = 68,          ///< n + 1
  lagrange_triangle = 69,       ///< (n + 1) (n + 2) / 2
  lagrange_quadrilateral = 70,  ///< (n + 1)^2
  bezier_curve = 75,            ///< n + 1
  bezier_triangle = 76,         ///< (n + 1) (n + 2) / 2
  bezier_quadrilateral = 77,    ///< (n + 1)^2
};

/// VTK's number of a type.
constexpr std::uint8_t vtk_number(CellType type) { return static_cast<std::uint8_t>(type); }

}  // namespace v0_1
}  // namespace tessera
