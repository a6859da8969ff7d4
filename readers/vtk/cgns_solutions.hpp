// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cells/cell_block.hpp"
#include "readers/vtk/cgns_cells.hpp"

namespace tessera::readers {

using CgnsName = std::array<char, 34>;

/// Whether a zone has three-dimensional cells.
bool is_mesh(const CgnsZone& zone);

/// Returns the number of points or cells along each index of a zone.
std::vector<cgsize_t> lengths(const CgnsZone& zone, bool of_cells);

/// Returns the total number of points or cells. Throws Error(bad_input) for 2^32 and more.
std::size_t product(const CgnsZone& zone, bool of_cells);

/// Returns the names of a zone's grids or solutions at a step; empty if the zone does not list them.
std::vector<std::string> zone_names_at_step(const CgnsZone& zone, std::uint64_t step, std::string_view word);

/// A solution of a zone.
struct CgnsSolution {
  int number = 0;
  std::string name{};
  CGNS_ENUMT(GridLocation_t) location{};
  CGNS_ENUMT(PointSetType_t)
  set = CGNS_ENUMV(PointSetTypeNull);  ///< how the points or cells with values are listed;
                                       ///< null: all have values
  cgsize_t in_set = 0;

  [[nodiscard]] bool is_part() const { return set != CGNS_ENUMV(PointSetTypeNull); }
};

/// Returns the solutions of a zone at a step; all solutions if the zone does not list them.
std::vector<CgnsSolution> solutions_of(const CgnsZone& zone, std::uint64_t step);

/// Pairs of location and field name that occur in several solutions.
using CgnsNamesakes = std::set<std::pair<CGNS_ENUMT(GridLocation_t), std::string>>;
CgnsNamesakes namesakes_of(std::span<const CgnsZone> zones, std::uint64_t step);

/// Adds the fields of a zone's points and cells. Fields in `namesakes` are named SOLUTION/FIELD. Missing values are
/// NaN.
void set_fields(const CgnsZone& zone, std::uint64_t step, const CgnsNamesakes& namesakes, bool has_cell_values,
                cells::CellBlock& block, std::vector<std::string>& notes);

}  // namespace tessera::readers
