// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

namespace tessera::projection {

/// Selects the cells whose depths the lattice rasterizer would round visibly; these are rasterized in double precision,
/// which rounds to the nearest step. The effect of a depth error is proportional to `light_per_step`, extinction times
/// length. A wide perspective, whose rays travel far per unit of depth, multiplies it.
///
/// Planes have an error of some steps; under perspective, a quotient of floats has an additional error, relative to the
/// depth extent of the cell, though a ray's path through a thin cell may be a hundred-thousandth of this extent.
///   - One crossing may have an error of most_error, for any cell.
///   - Successive crossings of a ray have random errors. A ray sees about as many cells of a kind as have one optical
///     depth together: (error)^2 per optical depth of a cell may be most_error_squared.
///   - Errors below least_error are harmless, even a thousand of them.
struct DepthLimits {
  // In units of a pixel's value.
  static constexpr double most_error = 2.5e-6, most_error_squared = 1e-11, least_error = 5e-7;
  // Of planes in steps; of quotients relative to the cell's extent. The usual errors are about two standard deviations.
  static constexpr double usual_plane_error = 6, usual_quotient_error = 0x1p-23, most_quotient_error = 0x1p-22;

  double light_per_step = 0;                                      ///< largest change of a pixel per step of depth
  double least_extent = std::numeric_limits<double>::infinity();  ///< cells no deeper than this, in steps, are accurate

  DepthLimits() = default;
  DepthLimits(double light, bool perspective) : light_per_step(light) {
    const double steps = least_error / light - usual_plane_error;  // infinite without light
    if (perspective)
      least_extent = std::max(steps, 0.0) / usual_quotient_error;
    else if (steps < 0)
      least_extent = 0;
  }
};

}  // namespace tessera::projection
