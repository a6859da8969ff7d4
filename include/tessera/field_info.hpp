// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "tessera/association.hpp"

namespace tessera {
inline namespace v0_1 {

/// The field of ReadOptions::shape, which is no array of a file.
inline constexpr const char* shape_field_name = "shape (depth)";

/// One array of a file. Range and count are of all tuples, cells that were dropped included.
struct FieldInfo {
  std::string name;
  Association association = Association::point;
  int components = 1;
  std::string type;             ///< "float", "double", "int64", "uint8", ...
  double low = 0, high = 0;     ///< finite values, of the magnitude if there are several components; 0, 0 if none is
  std::uint64_t nan_count = 0;  ///< tuples that are NaN or infinite
  bool active = false;          ///< the file marks it as its scalars or vectors
  bool ids = false;             ///< it numbers cells or points: the file marks it so, or its values are 0 to n - 1 or
                                ///< 1 to n, each once (of integers from any number on)
  bool fractions = false;       ///< not all of its finite values are whole numbers

  bool operator==(const FieldInfo&) const = default;
};

/// What became of a mesh's cells and points. A cell is counted as read, then in at most one of ghost, hidden, nan,
/// not_volumetric; what remains is split into tets.
struct MeshCounts {
  std::uint64_t cells_read = 0;
  std::uint64_t cells_ghost = 0;            ///< dropped: another piece's (vtkGhostType bit 1, vtkGhostLevels > 0)
  std::uint64_t cells_hidden = 0;           ///< dropped: vtkGhostType bit 32, or a point of it hidden (2), IBLANK 0
  std::uint64_t cells_nan = 0;              ///< blanked: a coordinate or scalar of it is missing, NaN or infinite
  std::uint64_t cells_not_volumetric = 0;   ///< skipped: points, lines, faces
  std::uint64_t cells_zero_volume = 0;      ///< kept: all their tets have exactly no volume
  std::uint64_t cells_open = 0;             ///< dropped: polyhedra whose faces are no closed surface
  std::uint64_t cells_tangled = 0;          ///< kept: their tets differ in orientation, so they overlap
  std::uint64_t cells_quadratic = 0;        ///< kept: second or higher order (HigherOrderCells)
  std::uint64_t cells_polyhedra = 0;        ///< kept: polyhedra and convex point sets
  std::uint64_t polyhedra_from_inside = 0;  ///< of those: split from a point that was added inside
  std::uint64_t polyhedra_in_pieces = 0;    ///< of those: cut into tets one by one, as no point sees all of the inside
  std::uint64_t polyhedra_tangled = 0;      ///< of those: among cells_tangled
  /// Kept: an earlier cell has the same corners, and is drawn there too.
  std::uint64_t cells_duplicate = 0;
  std::uint64_t duplicates_dropped = 0;  ///< such cells that were dropped (ReadOptions::drop_duplicates)
  /// Of kept hexahedra, wedges, pyramids, voxels and prisms of five or six sides: how many there are, and how many of
  /// them are among cells_tangled.
  std::array<std::uint64_t, 5> solids{}, solids_tangled{};
  std::uint64_t points_read = 0;
  std::uint64_t points_unused = 0;   ///< of no tet
  std::uint64_t tets_made = 0;       ///< in the mesh
  std::uint64_t tets_collapsed = 0;  ///< not made: two of their corners are one point in space
  // Of ReadOptions::selection, and only of cells that are kept otherwise:
  std::uint64_t cells_out_of_range = 0;  ///< dropped: their values are not all within the threshold
  std::uint64_t cells_clipped = 0;       ///< dropped: clipped away altogether
  std::uint64_t cells_cut = 0;           ///< kept in part

  MeshCounts& operator+=(const MeshCounts& other);  ///< of another part
  bool operator==(const MeshCounts&) const = default;
};

inline MeshCounts& MeshCounts::operator+=(const MeshCounts& other) {
  cells_read += other.cells_read;
  cells_ghost += other.cells_ghost;
  cells_hidden += other.cells_hidden;
  cells_nan += other.cells_nan;
  cells_not_volumetric += other.cells_not_volumetric;
  cells_zero_volume += other.cells_zero_volume;
  cells_open += other.cells_open;
  cells_tangled += other.cells_tangled;
  cells_quadratic += other.cells_quadratic;
  cells_polyhedra += other.cells_polyhedra;
  polyhedra_from_inside += other.polyhedra_from_inside;
  polyhedra_in_pieces += other.polyhedra_in_pieces;
  polyhedra_tangled += other.polyhedra_tangled;
  cells_duplicate += other.cells_duplicate;
  duplicates_dropped += other.duplicates_dropped;
  for (std::size_t kind = 0; kind < solids.size(); ++kind) {
    solids[kind] += other.solids[kind];
    solids_tangled[kind] += other.solids_tangled[kind];
  }
  points_read += other.points_read;
  points_unused += other.points_unused;
  tets_made += other.tets_made;
  tets_collapsed += other.tets_collapsed;
  cells_out_of_range += other.cells_out_of_range;
  cells_clipped += other.cells_clipped;
  cells_cut += other.cells_cut;
  return *this;
}
static_assert(sizeof(MeshCounts) == 32 * sizeof(std::uint64_t));  // each is added above

/// How near tets come to cells of second and higher order where nothing else is said: in position of the mesh's
/// diagonal, in value of the field's range; and about how many there may be: not more than 2^18 and twice as many as
/// the mesh takes without the worst 48 of the tets that its cells' corners make, so that damage takes no memory out of
/// proportion. Any other number is taken as it is.
inline constexpr double default_higher_order_tolerance = 1e-4;
inline constexpr std::uint64_t default_higher_order_tets = std::uint64_t{1} << 21;

/// What became of a mesh's cells of second and higher order.
struct HigherOrderCells {
  std::uint64_t divided = 0;     ///< into tets that are as near to them as the bounds below say
  std::uint64_t by_corners = 0;  ///< drawn as linear cells by their corners, of kinds that are not divided: no bound
  std::uint64_t tets = 0;        ///< made of those divided
  double position_error = 0;     ///< the most that a point of a tet is away from where the cell has it, world units
  double field_error = 0;        ///< the most that the field is off at one place, in its unit; to first order
  double tolerance = 0;          ///< what was asked for or, where that took too many tets, what was aimed at instead

  HigherOrderCells& operator+=(const HigherOrderCells& other);  ///< of another part
  bool operator==(const HigherOrderCells&) const = default;
};

inline HigherOrderCells& HigherOrderCells::operator+=(const HigherOrderCells& other) {
  divided += other.divided;
  by_corners += other.by_corners;
  tets += other.tets;
  position_error = position_error < other.position_error ? other.position_error : position_error;
  field_error = field_error < other.field_error ? other.field_error : field_error;
  tolerance = tolerance < other.tolerance ? other.tolerance : tolerance;
  return *this;
}
static_assert(sizeof(HigherOrderCells) == 6 * sizeof(double));  // one line above for each

}  // namespace v0_1
}  // namespace tessera
