// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "tessera/counter.hpp"

namespace tessera {
inline namespace v0_1 {

/// Counts of a mesh's cells and points by how they were handled. Every cell is counted in cells_read and in at most one
/// of cells_ghost, cells_hidden, cells_nan and cells_not_volumetric; the remaining cells are split into tets. The table
/// mesh_counters contains the names and meanings of the counters.
struct MeshCounts {
  std::uint64_t cells_read = 0;
  std::uint64_t cells_ghost = 0;            ///< dropped: belong to another piece (vtkGhostType bit 1, vtkGhostLevels >
                                            ///< 0)
  std::uint64_t cells_hidden = 0;           ///< dropped: vtkGhostType bit 32, a hidden point (bit 2), or IBLANK 0
  std::uint64_t cells_nan = 0;              ///< dropped: a coordinate or scalar is missing, NaN or infinite
  std::uint64_t cells_not_volumetric = 0;   ///< skipped: points, lines, faces
  std::uint64_t cells_zero_volume = 0;      ///< kept: all their tets have exactly zero volume
  std::uint64_t cells_open = 0;             ///< dropped: polyhedra whose faces do not form a closed surface
  std::uint64_t cells_tangled = 0;          ///< kept: their tets differ in orientation, so they overlap
  std::uint64_t cells_quadratic = 0;        ///< kept: second or higher order (HigherOrderCells)
  std::uint64_t cells_polyhedra = 0;        ///< kept: polyhedra and convex point sets
  std::uint64_t polyhedra_from_inside = 0;  ///< polyhedra split into tets around a point that was added inside
  std::uint64_t polyhedra_in_pieces = 0;    ///< polyhedra from which single tets were cut, because no single point sees
                                            ///< the whole inside
  std::uint64_t polyhedra_tangled = 0;      ///< polyhedra that are also counted in cells_tangled
  /// Kept: cells that have the corners of an earlier cell; both are drawn.
  std::uint64_t cells_duplicate = 0;
  std::uint64_t duplicates_dropped = 0;  ///< duplicate cells that were dropped (ReadOptions::drop_duplicates)
  /// Numbers of kept cells of these kinds, and how many of them are counted in cells_tangled. Prisms have five or six
  /// sides.
  std::uint64_t hexahedra = 0, hexahedra_tangled = 0, wedges = 0, wedges_tangled = 0, pyramids = 0,
                pyramids_tangled = 0, voxels = 0, voxels_tangled = 0, prisms = 0, prisms_tangled = 0;
  std::uint64_t points_read = 0;
  std::uint64_t points_unused = 0;   ///< used by no tet
  std::uint64_t tets_made = 0;       ///< in the mesh
  std::uint64_t tets_collapsed = 0;  ///< not made, because two of their corners have the same position
  // Effects of ReadOptions::selection on the cells that are otherwise kept:
  std::uint64_t cells_out_of_range = 0;  ///< dropped: their values are not all within the threshold
  std::uint64_t cells_clipped = 0;       ///< dropped: completely clipped away
  std::uint64_t cells_cut = 0;           ///< kept in part

  MeshCounts& operator+=(const MeshCounts& other);  ///< adds the counts of another part of the mesh
  bool operator==(const MeshCounts&) const = default;
};

/// A row of the table of MeshCounts. If a name contains a slash, the part before the slash is the name of a group;
/// reports omit a group with `if_any` if all its counters are 0. Reports also omit counters without a name. In the line
/// about cells that the program prints, `meaning` follows the number.
struct MeshCounter : Counter<MeshCounts> {
  enum class Fate {
    other,  ///< the counter is not in the line about cells
    kept,
    dropped  ///< the cells were read, but are not in the mesh
  };
  Fate fate;
};

/// All counters of MeshCounts, in the order of reports.
inline constexpr std::array<MeshCounter, 32> mesh_counters{{
    {{"cells/read", &MeshCounts::cells_read, MeshCounter::Together::sum, false, "of the file"},
     MeshCounter::Fate::other},
    {{"cells/ghost", &MeshCounts::cells_ghost, MeshCounter::Together::sum, false, "ghost dropped"},
     MeshCounter::Fate::dropped},
    {{"cells/hidden", &MeshCounts::cells_hidden, MeshCounter::Together::sum, false, "hidden dropped"},
     MeshCounter::Fate::dropped},
    {{"cells/nan", &MeshCounts::cells_nan, MeshCounter::Together::sum, false,
      "dropped for NaN, infinite or missing numbers"},
     MeshCounter::Fate::dropped},
    {{"cells/not_volumetric", &MeshCounts::cells_not_volumetric, MeshCounter::Together::sum, false,
      "without volume by type skipped"},
     MeshCounter::Fate::dropped},
    {{"cells/zero_volume", &MeshCounts::cells_zero_volume, MeshCounter::Together::sum, false, "of zero volume kept"},
     MeshCounter::Fate::kept},
    {{"cells/open", &MeshCounts::cells_open, MeshCounter::Together::sum, false, "not closed dropped"},
     MeshCounter::Fate::dropped},
    {{"cells/tangled", &MeshCounts::cells_tangled, MeshCounter::Together::sum, false, "tangled kept"},
     MeshCounter::Fate::kept},
    {{"cells/quadratic", &MeshCounts::cells_quadratic, MeshCounter::Together::sum, false, "of higher order"},
     MeshCounter::Fate::kept},
    {{"cells/duplicate", &MeshCounts::cells_duplicate, MeshCounter::Together::sum, false, "duplicate kept"},
     MeshCounter::Fate::kept},
    {{"cells/duplicates_dropped", &MeshCounts::duplicates_dropped, MeshCounter::Together::sum, false,
      "duplicate dropped"},
     MeshCounter::Fate::dropped},
    {{"selection/cells_out_of_range", &MeshCounts::cells_out_of_range, MeshCounter::Together::sum, true,
      "outside the threshold dropped"},
     MeshCounter::Fate::dropped},
    {{"selection/cells_clipped", &MeshCounts::cells_clipped, MeshCounter::Together::sum, true, "clipped away"},
     MeshCounter::Fate::dropped},
    {{"selection/cells_cut", &MeshCounts::cells_cut, MeshCounter::Together::sum, true, "cut"}, MeshCounter::Fate::kept},
    {{"polyhedra/kept", &MeshCounts::cells_polyhedra, MeshCounter::Together::sum, true,
      "polyhedra and convex point sets"},
     MeshCounter::Fate::other},
    {{"polyhedra/from_inside", &MeshCounts::polyhedra_from_inside, MeshCounter::Together::sum, true,
      "split from a point inside"},
     MeshCounter::Fate::other},
    {{"polyhedra/in_pieces", &MeshCounts::polyhedra_in_pieces, MeshCounter::Together::sum, true,
      "cut into tets one by one"},
     MeshCounter::Fate::other},
    {{"polyhedra/tangled", &MeshCounts::polyhedra_tangled, MeshCounter::Together::sum, true,
      "drawn by tets that overlap"},
     MeshCounter::Fate::other},
    {{"tets", &MeshCounts::tets_made, MeshCounter::Together::sum, false, "in the mesh"}, MeshCounter::Fate::other},
    {{"tets_collapsed", &MeshCounts::tets_collapsed, MeshCounter::Together::sum, false, "not made"},
     MeshCounter::Fate::other},
    {{"points/read", &MeshCounts::points_read, MeshCounter::Together::sum, false, "of the file"},
     MeshCounter::Fate::other},
    {{"points/unused", &MeshCounts::points_unused, MeshCounter::Together::sum, false, "of no tet"},
     MeshCounter::Fate::other},
    {{"", &MeshCounts::hexahedra, MeshCounter::Together::sum, true, "kept"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::hexahedra_tangled, MeshCounter::Together::sum, true, "of them tangled"},
     MeshCounter::Fate::other},
    {{"", &MeshCounts::wedges, MeshCounter::Together::sum, true, "kept"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::wedges_tangled, MeshCounter::Together::sum, true, "of them tangled"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::pyramids, MeshCounter::Together::sum, true, "kept"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::pyramids_tangled, MeshCounter::Together::sum, true, "of them tangled"},
     MeshCounter::Fate::other},
    {{"", &MeshCounts::voxels, MeshCounter::Together::sum, true, "kept"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::voxels_tangled, MeshCounter::Together::sum, true, "of them tangled"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::prisms, MeshCounter::Together::sum, true, "kept"}, MeshCounter::Fate::other},
    {{"", &MeshCounts::prisms_tangled, MeshCounter::Together::sum, true, "of them tangled"}, MeshCounter::Fate::other},
}};
static_assert(sizeof(MeshCounts) == mesh_counters.size() * sizeof(std::uint64_t), "a counter is not in the table");

inline MeshCounts& MeshCounts::operator+=(const MeshCounts& other) {
  add_counters(mesh_counters, other, *this);
  return *this;
}

/// Counts and errors of the mesh's cells of second and higher order.
struct HigherOrderCells {
  std::uint64_t divided = 0;     ///< divided into tets within the errors below
  std::uint64_t by_corners = 0;  ///< drawn as linear cells between their corners, because their kind is not divided;
                                 ///< without an error bound
  std::uint64_t tets = 0;        ///< made from the divided cells
  double tolerance = 0;          ///< the requested tolerance or, if it required too many tets, the larger one that was
                                 ///< used
  double position_error = 0;     ///< largest distance of a point of a tet from its exact place in the cell, world units
  double field_error = 0;        ///< largest error of the field at any place, in the field's unit; estimated to first
                                 ///< order

  HigherOrderCells& operator+=(const HigherOrderCells& other);  ///< adds the counts of another part of the mesh
  bool operator==(const HigherOrderCells&) const = default;
};
using HigherOrderCounter = Counter<HigherOrderCells>;
using HigherOrderBound = Counter<HigherOrderCells, double>;

/// All counters of HigherOrderCells, in the order of reports.
inline constexpr std::array<HigherOrderCounter, 3> higher_order_counters{{
    {"divided", &HigherOrderCells::divided, HigherOrderCounter::Together::sum, false, "cells divided into tets"},
    {"by_corners", &HigherOrderCells::by_corners, HigherOrderCounter::Together::sum, false, "cells drawn by corners"},
    {"tets", &HigherOrderCells::tets, HigherOrderCounter::Together::sum, false, "tets made of the divided cells"},
}};
inline constexpr std::array<HigherOrderBound, 3> higher_order_bounds{{
    {"tolerance", &HigherOrderCells::tolerance, HigherOrderBound::Together::largest, false, "asked for, or aimed at"},
    {"position_error", &HigherOrderCells::position_error, HigherOrderBound::Together::largest, false, "world units"},
    {"field_error", &HigherOrderCells::field_error, HigherOrderBound::Together::largest, false, "in the field's unit"},
}};
static_assert(sizeof(HigherOrderCells) == (higher_order_counters.size() + higher_order_bounds.size()) * sizeof(double),
              "a counter is not in the tables");

inline HigherOrderCells& HigherOrderCells::operator+=(const HigherOrderCells& other) {
  add_counters(higher_order_counters, other, *this);
  add_counters(higher_order_bounds, other, *this);
  return *this;
}
static_assert(std::is_trivially_copyable_v<MeshCounts> && std::is_trivially_copyable_v<HigherOrderCells>,
              "processes send them unchanged");

}  // namespace v0_1
}  // namespace tessera
