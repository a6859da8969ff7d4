// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "scene/lattice.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::integrals {

/// Converts a value to a scalar for float lanes: the nearest integer number of units from the origin, clamped to
/// +-2^30. Vertices and knots are rounded in the same way, so that scalars equal to the value of a step remain equal to
/// it.
float lane_scalar(double value, double scalar_origin, double scalar_unit);

/// How the knots of a step are rounded. This matters because the data may contain exactly the value of the step.
enum class StepRounding {
  nearest,  ///< like all other knots
  up        ///< to the next float at or above, so that values that are exact as floats stay on their side of the step
};

/// A transfer function as a table for float lanes (integrate_lanes-inl.h).
///
/// Intervals The K distinct positions of the knots separate K + 1 intervals, on each of which extinction and colour are
///           linear. The first and the last interval are constant. A step is an edge at which the two adjacent
///           intervals have different values; at the step, the function has the value of the upper interval.
/// Units     Scalars are results of lane_scalar(); lengths are in `length_unit` world units. Extinction is stored
///           multiplied by length_unit, and so is colour under independent emission, so that scenes of size 1e-20 or
///           1e20 are in the range of a float.
/// Rounding  The table is the function through the rounded knots. The function is cut off at +-2^30 units. Numbers
///           above 1e18 are stored as 1e18.
/// Halves    Extinction is stored halved, because the integral uses half the optical depth at each end of a segment.
/// Accuracy  channel(s) = start + slope * (s - base), where base is the end of the interval with the smaller
///           extinction. Both terms are then >= 0, and extinction keeps its relative accuracy near a knot of zero
///           extinction.
struct LaneTable {
  /// Each column of the function's table is stored as one row of `rows`. `edge[i]` is the lower end of interval i;
  /// edge[0] = -inf, and all elements from edge[K + 1] to the end of the row are +inf.
  enum Column {
    edge,
    base,
    half_extinction,
    half_extinction_slope,
    red,
    red_slope,
    green,
    green_slope,
    blue,
    blue_slope,
    column_count
  };
  /// Rows have at least this many elements more than K + 2, so that whole vectors can be loaded from any interval
  /// onwards.
  static constexpr std::size_t padding = 64;

  /// `scalar_unit` and `length_unit` must be powers of two.
  LaneTable(const scene::TransferFunction& function, double scalar_origin, double scalar_unit, double length_unit,
            scene::Emission emission, StepRounding steps = StepRounding::nearest);
  /// Makes the table for segments on a lattice, whose lengths are in the lattice's depth steps.
  LaneTable(const scene::TransferFunction& function, const scene::Lattice& lattice, scene::Emission emission)
      : LaneTable(function, lattice.scalar_origin, lattice.scalar_unit, lattice.depth_unit, emission) {}

  [[nodiscard]] const float* column(int c) const { return rows.data() + static_cast<std::size_t>(c) * stride; }

  std::size_t knot_count;  ///< K
  scene::Emission emission;
  double color_unit;        ///< the colour that the number 1 represents in the rows of colours
  bool has_clear;           ///< whether there is an interval that neither absorbs nor emits
  std::size_t stride;       ///< elements per row of `rows`
  std::vector<float> rows;  ///< column_count rows
  /// Indexed by edge, 1 to K: the least and largest value of the knots rounded to that edge.
  std::vector<std::array<double, 2>> edge_values;
  /// Indexed by edge, 1 to K: whether the edge is exactly one step of the function, without other knots.
  std::vector<std::uint8_t> is_step;
  /// Indexed by edge, 1 to K: whether a knot between the first and the last knot at the edge absorbs or emits. Lanes
  /// cannot resolve the width of such a peak.
  std::vector<std::uint8_t> has_peak;
  /// Indexed by edge, 1 to K: whether rounding moved knots so far that absorption or emission per length unit near them
  /// changes by more than 1e-7, or merged knots of different values.
  std::vector<std::uint8_t> is_moved;
  bool has_steps = false;  ///< whether the function has any steps

  // A uniform grid over the range of the knots, which gives the start of the search for a scalar's interval. Cell j
  // covers the scalars for which (s - grid_origin) * grid_scale, clamped to the grid and truncated, is j.
  float grid_origin = 0, grid_scale = 0, last_cell = 0;
  std::vector<std::int32_t> knots_before;  ///< for each cell, the number of knots in all lower cells
  std::size_t largest_step = 0;            ///< first step of a binary search within a cell, a power of two
};

}  // namespace tessera::integrals
