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

/// A scalar as float lanes see it: the nearest whole number of units from the origin, kept within +-2^30. Vertices and
/// knots go through this one rounding, so that data that equal a step's value stay equal to it.
float lane_scalar(double value, double scalar_origin, double scalar_unit);

/// Where the knots of a step go, of which the data may hold the very value.
enum class StepRounding {
  nearest,  ///< as all knots
  up        ///< to the next float at or above: what floats hold exactly stays on its side of the step
};

/// A transfer function laid out for float lanes (integrate_lanes-inl.h).
///
/// Intervals  the K distinct positions of its knots make K + 1, on each of which extinction and colour are linear.
///            Those below the first and above the last are constant. A step is where two neighbours disagree; it takes
///            no interval of its own, and its value is that of the interval above.
/// Units      scalars as lane_scalar() gives them; lengths in `length_unit` world units. Extinction is stored times
///            length_unit, and so is colour under independent emission, so that scenes of 1e-20 or 1e20 fit a float.
/// Rounding   the table is the function through the rounded knots; knots beyond +-2^30 units are cut off there. Numbers
///            above 1e18 are stored as 1e18.
/// Halves     extinction is stored halved: the integral wants half the optical depth at either end of a segment.
/// Accuracy   channel(s) = start + slope * (s - base), where base is the end of the interval at which extinction is
///            smaller: both terms are then >= 0, and extinction keeps its relative accuracy down to a knot at zero.
struct LaneTable {
  /// One row each; `edge[i]` is where interval i begins, edge[0] = -inf, edge[K + 1] = +inf and so on to the row's end.
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
  /// Rows are longer than K + 2 by this, so that whole vectors may be loaded from any interval on.
  static constexpr std::size_t padding = 64;

  /// `scalar_unit` and `length_unit` are powers of two.
  LaneTable(const scene::TransferFunction& function, double scalar_origin, double scalar_unit, double length_unit,
            scene::Emission emission, StepRounding steps = StepRounding::nearest);
  /// Of segments on a lattice, whose steps of depth are the lengths' unit.
  LaneTable(const scene::TransferFunction& function, const scene::Lattice& lattice, scene::Emission emission)
      : LaneTable(function, lattice.scalar_origin, lattice.scalar_unit, lattice.depth_unit, emission) {}

  [[nodiscard]] const float* column(int c) const { return rows.data() + static_cast<std::size_t>(c) * stride; }

  std::size_t knot_count;  ///< K
  scene::Emission emission;
  bool has_clear;           ///< an interval neither absorbs nor emits
  std::size_t stride;       ///< of `rows`
  std::vector<float> rows;  ///< column_count rows
  /// By edge, 1 to K: least and largest value of the knots that lie there once rounded.
  std::vector<std::array<double, 2>> edge_values;
  /// By edge, 1 to K: whether a step of the function, and nothing else, lies there.
  std::vector<std::uint8_t> is_step;
  /// By edge, 1 to K: whether a knot between the first and the last that lie there shows anything, in a width that
  /// lanes do not tell from a point.
  std::vector<std::uint8_t> has_peak;
  /// By edge, 1 to K: whether rounding moved knots so far that what a length unit absorbs, or sends, beside them
  /// changes by more than 1e-7, or put knots of different values there.
  std::vector<std::uint8_t> is_moved;
  bool has_steps = false;  ///< whether any of the function's knots make a step

  // Many knots: a uniform grid over the knots' range leads to a scalar's interval. Cell j covers the
  // scalars for which truncating (s - grid_origin) * grid_scale, clamped to the grid, gives j.
  float grid_origin = 0, grid_scale = 0, last_cell = 0;
  std::vector<std::int32_t> knots_before;  ///< knots in lower cells
  std::size_t largest_step = 0;            ///< first step of a binary search within a cell, a power of two
};

}  // namespace tessera::integrals
