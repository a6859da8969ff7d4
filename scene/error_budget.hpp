// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

/// What pixels may differ by from exact arithmetic, in linear RGBA, and which cause may take how much of it. All shares
/// are given out here. On each way to a picture they add up to no more than what was promised
/// (tests/scene/error_budget_test.cpp; docs/ACCURACY.md has the sums).
///
/// `accuracy` is what was asked of IntegratorKind::automatic. What is said of a number is for pixels up to one; float
/// arithmetic errs in proportion to the brightest light that a ray can have.
namespace tessera::scene::error_budget {

// Promises.
constexpr double exact_mesh = 2e-5, exact_grid = 1e-5;
constexpr double exact_layers = 1e-5;  ///< of each layer of a peeled picture, or less if less was asked
/// The least accuracy that can be asked: pictures are 32-bit floats, of 6e-8.
constexpr double least_accuracy = 1e-6;

// Errors of a size of their own.
constexpr double float_picture = 0x1p-24;
constexpr double lane_integrals = 5e-7;  ///< of segments in float lanes, on the integer lattice
constexpr double lane_rays = 1e-6;       ///< of grids' rays in float lanes, besides what these note
constexpr double runs = 2e-6;            ///< Exchange::runs: light and opacity of runs are floats

// Shares of the accuracy.
/// What may come behind the place where a ray is ended, or a segment (absorption).
constexpr double ended(double accuracy) { return std::min(accuracy / 4, 1e-2); }
/// Pieces of segments that are thicker than one optical depth, all of a ray's.
constexpr double thick_pieces(double accuracy) { return accuracy / 64; }
/// What is left out of segments behind dense matter, all of a ray's.
constexpr double dark_pieces(double accuracy) { return accuracy / 64; }
/// Scalars that are rounded to the integer lattice.
constexpr double lattice_scalars(double accuracy) { return std::min(2e-5, 0.6 * accuracy); }
constexpr double lattice_scalars_of_exact = 0.75 * exact_mesh;
/// What grids' lanes note that steps, ramps and ends may err (volume/lane_error_bound.hpp); rays beyond it are cast
/// again in double precision.
constexpr double noted(double accuracy) { return accuracy / 2; }
/// One stretch of a grid's ray that is taken for a line or a parabola in float lanes, and all of a ray together. The
/// sum is an estimate that random scenes have not exceeded (bench/stability/), not a bound.
constexpr double grid_piece(double accuracy) { return accuracy / 64; }
constexpr double grid_pieces(double accuracy) { return accuracy / 8; }
/// The same in double precision. The sum is that of a thousand stretches; rays with more that matter were not met.
constexpr double precise_piece(double accuracy) { return std::min(2e-9, accuracy / 2048); }
constexpr double precise_pieces(double accuracy) { return accuracy / 2; }
/// What the formulas above take for the accuracy of a grid's `exact`, which promises more by as much as they leave out.
constexpr double casting_of_exact_grid = 2e-6;

// Deep pictures, of `deep_accuracy`, cut anywhere: pieces, pieces that are merged, and the rounding of alpha.
constexpr double deep_pieces(double accuracy) { return accuracy / 2; }
constexpr double deep_merging(double accuracy) { return accuracy / 4; }
constexpr double deep_alpha(double accuracy) { return accuracy / 16; }

// Ways to a picture, and what they come to; `brightest` is the most light that a ray can have, at least one.
constexpr double mesh_on_lattice(double accuracy, double brightest = 1) {
  return lattice_scalars(accuracy) + ended(accuracy) + brightest * (lane_integrals + float_picture);
}
constexpr double exact_mesh_on_lattice(double brightest = 1) {
  return lattice_scalars_of_exact + brightest * (lane_integrals + float_picture);
}
constexpr double mesh_in_double(double accuracy, double brightest = 1) {
  return ended(accuracy) + thick_pieces(accuracy) + dark_pieces(accuracy) + brightest * float_picture;
}
constexpr double grid_in_lanes(double accuracy, double brightest = 1) {
  return ended(accuracy) + noted(accuracy) + grid_pieces(accuracy) + brightest * (lane_rays + float_picture);
}
constexpr double exact_grid_in_lanes(double brightest = 1) {
  return ended(casting_of_exact_grid) + noted(exact_grid) + grid_pieces(casting_of_exact_grid) +
         brightest * (lane_rays + float_picture);
}
constexpr double grid_in_double(double accuracy, double brightest = 1) {
  return ended(accuracy) + precise_pieces(accuracy) + brightest * float_picture;
}
constexpr double deep(double accuracy) {
  return deep_pieces(accuracy) + deep_merging(accuracy) + deep_alpha(accuracy) + float_picture;
}

/// Whether Exchange::runs fits in as well.
constexpr bool runs_keep(double accuracy) {
  const double lattice = mesh_on_lattice(accuracy);
  return (lattice <= accuracy ? lattice : mesh_in_double(accuracy)) + runs <= accuracy;
}

}  // namespace tessera::scene::error_budget

namespace tessera::scene {

/// The most light that a ray can have over that length, or 1 if that is more. Of independent emission no more than
/// color over extinction, which is the light in matter without end.
double most_light(const TransferFunction& function, Emission emission, double length);

/// Throws Error(bad_input) for an accuracy that cannot be kept.
void check_accuracy(double accuracy);

}  // namespace tessera::scene
