// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "integrals/piecewise_table.hpp"
#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

namespace tessera::integrals {

/// A transfer function pre-integrated over all segments, indexed by the scalars at both ends and the length (Roettger,
/// Kraus, Ertl, "Hardware-Accelerated Volume and Isosurface Rendering Based on Cell-Projection", Visualization 2000,
/// after Engel's idea for equal steps).
///
/// The table stores the quantity that varies least. Let K(s_f, s_b) be the segment's mean extinction, which is exact in
/// two dimensions, and tau = K l its optical depth. Light is stored as
///   P = light * K / (1 - exp(-tau)),
/// which tends to the mean of kappa c (independent emission: the mean of c) as l tends to 0, and is constant where the
/// colour is constant. The third axis is w = tau / (tau + 2), from 0 to 1.
///
/// Grid      K is tabulated at size x size scalars, one row per front scalar, at equal steps from the first to the last
///           knot. P has size / 4 + 1 equal steps of w in addition, and four floats per entry: red, green, blue and one
///           that is not used. Outside the knots the function is constant; those parts of a segment are cut off and
///           integrated without the table.
/// Exact     The table is exact (to the precision of float, 6e-8) for constant colour over linear extinction without
///           knots inside, and for homogeneous segments whose scalar is on the grid.
/// Error     The error of linear interpolation decreases as size^-2 where the function is smooth between the segment's
///           ends, as size^-1 near its kinks, and not at all at its steps. There is no bound here; tests measure the
///           error.
struct SegmentTable {
  static constexpr int default_size = 128;

  /// `size` must be at least 8. Computes size^3 / 4 exact integrals.
  SegmentTable(const scene::TransferFunction& function, scene::Emission emission, int size = default_size);

  struct Constant {
    double extinction, red, green, blue;
  };

  int size, depths;
  double low, high, scale;  ///< first and last knot; entries per unit of the scalar, 0 if both knots are equal
  std::vector<float> mean_extinction;  ///< size^2
  std::vector<float> light;            ///< size^2 * depths * 4
  Constant below, above;               ///< the function below the first and above the last knot
};

}  // namespace tessera::integrals
