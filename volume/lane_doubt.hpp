#pragma once

#include <vector>

#include "compositor/lane_table.hpp"
#include "volume/cell_ranges.hpp"

namespace tessera::volume {

/// Where float lanes cannot tell a ray's light to the accuracy asked: rays of which that may be are cast again in
/// double precision (voxel_cast.hpp).
///
/// Steps   a ray that all but touches the surface of a step of the transfer function sees it for a length whose
///         error is the square root of the field's: where that is level + a (u - u0)^2, rounding of 1e-7 makes or
///         moves crossings by 3e-4. Lanes add up what such places may err (ray_piece-inl.h).
/// Ramps   where the function is steep, the field's error shows for as long as a ray stays there.
struct LaneDoubt {
  /// By edge of the table (LaneTable::edge), as long as a row of it: the light and opacity, per unit of length, that
  /// differ between its two sides; 0 where that is too little to matter. Empty: no edge is a step.
  std::vector<float> step;
  /// By interval of the table: error of light and opacity per unit of length; 0 and empty as above.
  std::vector<float> ramp;
  float most = 1;   ///< error of light or opacity that one place can make
  float noise = 0;  ///< of the field in float lanes, lane scalars

  LaneDoubt() = default;
  /// `least`: errors of light or opacity that do not matter; `longest`: of a ray in a voxel, in the table's unit.
  LaneDoubt(const compositor::LaneTable& table, const CellRanges& ranges, double largest_color, double least,
            double longest);

  [[nodiscard]] bool any() const { return !step.empty() || !ramp.empty(); }
};

}  // namespace tessera::volume
