#pragma once

#include <vector>

#include "compositor/lane_table.hpp"
#include "volume/cell_ranges.hpp"

namespace tessera::volume {

/// Steps of the transfer function, and how near to one the field of float lanes is not told from it.
///
/// Why     a ray that all but touches the surface of a step sees it for a length whose error is the square root of the
///         field's: where that is level + a (u - u0)^2, rounding of 1e-7 makes or moves crossings by 3e-4. Lanes note
///         such places (ray_piece-inl.h); a ray that has one worth seeing is cast again in double precision
///         (voxel_cast.hpp).
struct TouchedSteps {
  /// By edge of the table (LaneTable::edge), as long as a row of it: the light and opacity, per unit of length, that
  /// differ between its two sides; 0 if what differs is too little to matter. Empty: no edge is a step.
  std::vector<float> weight;
  float most = 1;   ///< error of light or opacity that one place can make
  float noise = 0;  ///< of the field in float lanes, lane scalars

  TouchedSteps() = default;
  /// `least`: errors of light or opacity that do not matter; `longest`: of a ray in a voxel, in the table's unit.
  TouchedSteps(const compositor::LaneTable& table, const CellRanges& ranges, double largest_color, double least,
               double longest);
};

}  // namespace tessera::volume
