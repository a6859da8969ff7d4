// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

namespace tessera::projection {

/// Which cells' depths the lattice rasterizer rounds so that it could show; double precision, which rounds to the
/// nearest step, takes these. An error of depth matters by what a ray gets on the way: `light_per_step`, extinction
/// times length, so a wide perspective, whose rays go far in a little depth, multiplies it.
///
/// Planes err by some steps; under perspective a quotient of floats errs besides, by a part of what the cell spans in
/// depth, though a ray's way through a thin cell may be a hundred-thousandth of that.
///   - One crossing may err by most_error, whatever the cell.
///   - Crossings that a ray meets one after the other err at random. It sees about as many of a kind of cell as have
///     one optical depth together: (an error)^2 per optical depth of a cell may be most_error_squared.
///   - Errors below least_error do no harm, a thousand of them included.
struct DepthLimits {
  // Of a pixel.
  static constexpr double most_error = 2.5e-6, most_error_squared = 1e-11, least_error = 5e-7;
  // Of planes in steps, of quotients a part of what the cell spans; the usual ones are about two standard deviations.
  static constexpr double usual_plane_error = 6, usual_quotient_error = 0x1p-23, most_quotient_error = 0x1p-22;

  double light_per_step = 0;                                      ///< most that a step of depth can change a pixel by
  double least_extent = std::numeric_limits<double>::infinity();  ///< cells no deeper than this many steps are right

  DepthLimits() = default;
  DepthLimits(double light, bool perspective) : light_per_step(light) {
    const double steps = least_error / light - usual_plane_error;  // infinite where there is no light
    if (perspective)
      least_extent = std::max(steps, 0.0) / usual_quotient_error;
    else if (steps < 0)
      least_extent = 0;
  }
};

}  // namespace tessera::projection
