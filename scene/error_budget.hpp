// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"

/// How far pixels may differ from exact arithmetic, in linear RGBA, and the share of each cause. All shares are defined
/// here. For each method of rendering they add up to at most the promised error (tests/scene/error_budget_test.cpp;
/// docs/ACCURACY.md has the sums).
///
/// `accuracy` is the requested accuracy of IntegratorKind::automatic. The numbers hold for pixels up to one; the error
/// of float arithmetic is proportional to the brightest light that a ray can have.
namespace tessera::scene::error_budget {

// Promises.
constexpr double exact_mesh = 2e-5, exact_grid = 1e-5;
constexpr double exact_layers = 1e-5;  ///< of each layer of a peeled image, or less if less was requested
/// The smallest accuracy that can be requested: images are 32-bit floats, with an error of 6e-8.
constexpr double least_accuracy = 1e-6;

// Errors of fixed size.
constexpr double float_picture = 0x1p-24;
constexpr double lane_integrals = 5e-7;      ///< of segments in float lanes, on the integer lattice
constexpr double lane_lights = 4 * 0x1p-24;  ///< of shaded segments: light is a float, and so are its products
constexpr double lane_rays = 1e-6;           ///< of grids' rays in float lanes, in addition to their recorded bounds
constexpr double runs = 2e-6;                ///< Exchange::runs: light and opacity of runs are floats

// Shares of the accuracy.
/// Contribution behind the point where a ray, or a segment (absorption), is ended.
constexpr double ended(double accuracy) { return std::min(accuracy / 4, 1e-2); }
/// All pieces of a ray's segments that are thicker than one optical depth.
constexpr double thick_pieces(double accuracy) { return accuracy / 64; }
/// All parts of a ray's segments that are left out behind dense matter.
constexpr double dark_pieces(double accuracy) { return accuracy / 64; }
/// Rounding of scalars to the integer lattice.
constexpr double lattice_scalars(double accuracy) { return std::min(2e-5, 0.6 * accuracy); }
constexpr double lattice_scalars_of_exact = 0.75 * exact_mesh;
/// The error of steps, ramps and ends that grids' lanes record (volume/lane_error_bound.hpp); rays with larger errors
/// are cast again in double precision.
constexpr double noted(double accuracy) { return accuracy / 2; }
/// One interval of a grid's ray that float lanes approximate by a line or a parabola, and all intervals of a ray. The
/// sum is an estimate that random scenes have not exceeded (bench/stability/), not a bound.
constexpr double grid_piece(double accuracy) { return accuracy / 64; }
constexpr double grid_pieces(double accuracy) { return accuracy / 8; }
/// The same in double precision. The sum is that of a thousand intervals; no ray with more relevant intervals has been
/// found.
constexpr double precise_piece(double accuracy) { return std::min(2e-9, accuracy / 2048); }
constexpr double precise_pieces(double accuracy) { return accuracy / 2; }
/// The accuracy that these formulas use for a grid's `exact`; its promise is larger by the errors that they leave out.
constexpr double casting_of_exact_grid = 2e-6;

// Deep images, of `deep_accuracy`, cut anywhere: pieces, merged pieces, and the rounding of alpha.
constexpr double deep_pieces(double accuracy) { return accuracy / 2; }
constexpr double deep_merging(double accuracy) { return accuracy / 4; }
constexpr double deep_alpha(double accuracy) { return accuracy / 16; }

// Methods of rendering and their total errors; `brightest` is the most light that a ray can have, at least one.
constexpr double mesh_on_lattice(double accuracy, double brightest = 1, bool shaded = false) {
  return lattice_scalars(accuracy) + ended(accuracy) +
         brightest * (lane_integrals + (shaded ? lane_lights : 0) + float_picture);
}
constexpr double exact_mesh_on_lattice(double brightest = 1, bool shaded = false) {
  return lattice_scalars_of_exact + brightest * (lane_integrals + (shaded ? lane_lights : 0) + float_picture);
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

/// Whether the error of Exchange::runs also fits.
constexpr bool runs_keep(double accuracy, bool shaded = false) {
  const double lattice = mesh_on_lattice(accuracy, 1, shaded);
  return (lattice <= accuracy ? lattice : mesh_in_double(accuracy)) + runs <= accuracy;
}

}  // namespace tessera::scene::error_budget

namespace tessera::scene {

/// The most light that a ray of this length can have, at least 1. For independent emission at most color over
/// extinction, the light of infinitely deep matter.
double most_light(const TransferFunction& function, Emission emission, double length);

/// Throws Error(bad_input) for an accuracy that is out of range.
void check_accuracy(double accuracy);

}  // namespace tessera::scene
