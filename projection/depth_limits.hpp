// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

namespace tessera::projection {

/// Selects the cells whose depths the lattice rasterizer would round visibly. These cells are rasterized in double
/// precision, whose depths are rounded to the nearest step. The effect of a depth error is proportional to
/// `light_per_step` (extinction times length). A wide perspective, whose rays travel far per unit of depth, increases
/// it.
///
/// The planes of faces have an error of some steps. Under perspective, a quotient of floats has an additional error. It
/// is relative to the depth extent of the cell, although a ray's path through a thin cell may be a hundred-thousandth
/// of this extent.
///   - A single crossing of a ray and a face may have an error of most_error, in any cell.
///   - The errors of successive crossings of a ray are random. Cells that contribute to a pixel have a total optical
///     depth of about one along a ray. So the square of a cell's error may be most_error_squared times the cell's
///     optical depth.
///   - Errors below least_error are harmless, even if there are a thousand of them.
struct DepthLimits {
  // The unit of these errors is that of a pixel's value.
  static constexpr double most_error = 2.5e-6, most_error_squared = 1e-11, least_error = 5e-7;
  // Errors of planes are in steps; errors of quotients are relative to the cell's extent. The usual errors are about
  // two standard deviations.
  static constexpr double usual_plane_error = 6, usual_quotient_error = 0x1p-23, most_quotient_error = 0x1p-22;

  double light_per_step = 0;  ///< largest change of a pixel per step of depth
  /// Cells with at most this extent in depth, in steps, are accurate.
  double least_extent = std::numeric_limits<double>::infinity();

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
