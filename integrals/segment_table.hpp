// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "integrals/piecewise_table.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::integrals {

/// A transfer function integrated beforehand over all segments: by the scalars at both ends and the length (Roettger,
/// Kraus, Ertl, "Hardware-Accelerated Volume and Isosurface Rendering Based on Cell-Projection", Visualization 2000,
/// after Engel's idea for equal steps).
///
/// The table keeps what varies least. With K(s_f, s_b) the segment's mean extinction, exact in two dimensions, and
/// tau = K l its optical depth, light is kept as
///   P = light * K / (1 - exp(-tau)),
/// which tends to the mean of kappa c (independent emission: of c) as l goes to 0, and is constant where the colour is.
/// The third axis is w = tau / (tau + 2), from 0 to 1.
///
/// Grid    size x size scalars, the front's by row, at equal steps from the first to the last knot, for K; the same
///         times size / 4 + 1 steps of w for P, red, green, blue and one float unused. Outside the knots the function
///         is constant: such stretches are cut off and integrated without the table.
/// Exact   (to the floats' 6e-8) for constant colour over linear extinction without knots inside, and for homogeneous
///         segments whose scalar is an entry's.
/// Error   linear interpolation: falls with size^-2 where the function is smooth between the segment's ends, with
///         size^-1 near its kinks, and does not fall at its steps. Not bounded here; tests measure it.
struct SegmentTable {
  static constexpr int default_size = 128;

  /// size >= 8. Costs size^3 / 4 exact integrals.
  SegmentTable(const scene::TransferFunction& function, scene::Emission emission, int size = default_size);

  struct Constant {
    double extinction, red, green, blue;
  };

  int size, depths;
  double low, high, scale;             ///< first and last knot; entries a scalar, 0 if they are one
  std::vector<float> mean_extinction;  ///< size^2
  std::vector<float> light;            ///< size^2 * depths * 4
  Constant below, above;               ///< the function outside
};

}  // namespace tessera::integrals
