// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

#include "scene/optical_model.hpp"
#include "scene/transfer_function.hpp"
#include "tessera/surfaces.hpp"

/// The largest differences of pixels from exact arithmetic, in linear RGBA, and the shares of each cause of errors. All
/// shares are defined in this file. For each method of rendering, their sum is at most the promised error
/// (tests/scene/error_budget_test.cpp checks this; docs/ACCURACY.md lists the sums).
///
/// `accuracy` is the requested accuracy of IntegratorKind::automatic. The numbers are valid for pixel values up to one.
/// The error of single precision is proportional to the brightest light that a ray can have.
namespace tessera::scene::error_budget {

// Promised errors.
constexpr double exact_mesh = 2e-5, exact_grid = 1e-5;
constexpr double exact_layers = 1e-5;  ///< promised error of each layer of a peeled image, or the requested accuracy if
                                       ///< it is smaller
/// The smallest accuracy that can be requested: images are 32-bit floats, with an error of 6e-8.
constexpr double least_accuracy = 1e-6;

// Errors of fixed size.
constexpr double float_picture = 0x1p-24;
constexpr double lane_integrals = 5e-7;      ///< integrals of segments in single precision, on the integer lattice
constexpr double lane_lights = 4 * 0x1p-24;  ///< shaded segments: their light and its products have single precision
constexpr double lane_rays = 1e-6;           ///< rays of grids in single precision, in addition to their recorded
                                             ///< bounds
constexpr double runs = 2e-6;                ///< Exchange::runs: light and opacity of runs are sent in single precision
/// Light of surfaces on the integer lattice, for colours up to one. The cosine of the angle to the ray has 19 bits.
inline double lane_surfaces(const SurfaceLight& light) {
  constexpr double cosine = 0x1p-20;
  const double power = light.shininess >= 1 ? light.shininess * cosine : std::pow(cosine, light.shininess);
  return light.diffuse * cosine + (light.shininess > 0 ? light.specular * power : 0);
}

// Shares of the requested accuracy.
/// Contribution that is left out behind the end of a ray or, with absorption, of a segment.
constexpr double ended(double accuracy) { return std::min(accuracy / 4, 1e-2); }
/// Error of all pieces of a ray's segments that are thicker than one optical depth.
constexpr double thick_pieces(double accuracy) { return accuracy / 64; }
/// Error of all parts of a ray's segments that are left out behind dense matter.
constexpr double dark_pieces(double accuracy) { return accuracy / 64; }
/// Error due to rounding scalars to the integer lattice.
constexpr double lattice_scalars(double accuracy) { return 0.6 * accuracy; }
constexpr double lattice_scalars_of_exact = 0.75 * exact_mesh;
/// The largest recorded error of a grid's ray in single precision due to steps, ramps and ends
/// (volume/lane_error_bound.hpp). Rays with larger errors are cast again in double precision.
constexpr double noted(double accuracy) { return accuracy / 2; }
/// Error of one interval of a grid's ray that is approximated by a line or a parabola in single precision, and error of
/// all intervals of a ray. The error of all intervals is not a bound, but an estimate that random scenes have not
/// exceeded (bench/stability/).
constexpr double grid_piece(double accuracy) { return accuracy / 64; }
constexpr double grid_pieces(double accuracy) { return accuracy / 8; }
/// Error of one interval, and error of all intervals of a ray, in double precision. The error of all intervals is that
/// of a thousand intervals; no ray with more relevant intervals has been found.
constexpr double precise_piece(double accuracy) { return std::min(2e-9, accuracy / 2048); }
constexpr double precise_pieces(double accuracy) { return accuracy / 2; }
/// The accuracy with which these formulas are used for grids with the integrator `exact`. The promised error is larger,
/// because the formulas do not include all errors.
constexpr double casting_of_exact_grid = 2e-6;

/// Returns the error that rounding of scalars may cause in a pixel of a layer (Peel) on the integer lattice; the result
/// is not positive if the accuracy leaves nothing for it. Errors of scalars and lanes change the light of a layer, and
/// they also move the end of the layer, where the optical depth is d = -log(1 - threshold), so that light moves to
/// another layer (compositor/deep/layer_sink.hpp).
inline double scalars_of_layers(double accuracy, double threshold, double brightest = 1, bool shaded = false) {
  const double depth = -std::log1p(-threshold);
  const double lanes = lane_integrals + (shaded ? lane_lights : 0);
  return (accuracy - brightest * (lanes * (1 + 1.5 * depth) + float_picture)) / (1 + (1 + depth) / 2);
}

// Errors of deep images whose segments are cut at any depth, for `deep_accuracy`: pieces, merged pieces, the rounding
// of alpha, and what is left out behind the end of a ray.
constexpr double deep_pieces(double accuracy) { return accuracy / 2; }
constexpr double deep_merging(double accuracy) { return accuracy / 4; }
constexpr double deep_alpha(double accuracy) { return accuracy / 16; }
constexpr double deep_ended(double accuracy) { return accuracy / 16; }
/// The accuracy of the integrator for which ended() is deep_ended().
constexpr double integrator_of_deep(double accuracy) { return 4 * deep_ended(accuracy); }

// Total errors of the methods of rendering. `brightest` is the most light that a ray can have, at least one.
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
  return deep_pieces(accuracy) + deep_merging(accuracy) + deep_alpha(accuracy) + deep_ended(accuracy) + float_picture;
}
constexpr double deep_lanes = 1e-6;  ///< rounding of pieces and samples in float lanes
/// What is in front of a cut may have the error of an image, in its light and in its transmittance.
constexpr double deep_on_lattice(double accuracy, double brightest = 1, bool shaded = false) {
  return deep(accuracy) + 2 * exact_mesh_on_lattice(brightest, shaded) + deep_lanes;
}

/// Whether the accuracy also allows the error of Exchange::runs.
constexpr bool runs_keep(double accuracy, bool shaded = false) {
  const double lattice = mesh_on_lattice(accuracy, 1, shaded);
  return (lattice <= accuracy ? lattice : mesh_in_double(accuracy)) + runs <= accuracy;
}

}  // namespace tessera::scene::error_budget

namespace tessera::scene {

/// Returns the most light that a ray of this length can have, at least 1. For independent emission it is at most the
/// colour divided by the extinction, which is the light of infinitely deep matter.
double most_light(const TransferFunction& function, Emission emission, double length);

/// Throws Error(bad_input) for an accuracy that is out of range.
void check_accuracy(double accuracy);

}  // namespace tessera::scene
