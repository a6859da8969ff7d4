// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "integrals/lane_table.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::volume {

/// The parameters of LaneErrorBound that depend on the frame.
struct ErrorBoundSettings {
  bool cell_data = false;
  double largest_color = 1;
  double brightest = 1;  ///< largest light along a ray
  double least = 0;      ///< errors of light or opacity below this are ignored
  double longest = 1;    ///< longest part of a ray in a voxel, in the table's unit
  double unit = 1;       ///< the table's unit of length in world units
};

/// Bounds the error of light that is computed in float lanes. Lanes accumulate the errors described here
/// (ray_piece-inl.h). Rays whose sum of errors exceeds the tolerance are cast again in double precision
/// (voxel_cast.hpp).
///
/// Excess    Suppose that the optical depth of a medium of colour c is too large by e, at a position with transmittance
///           T in front of it and light I from behind. The light then changes by T e (c - I), and the opacity by e
///           times the transmittance of the whole ray. This is little in front of or inside dense matter of the same
///           colour.
/// Steps     A ray that almost touches the isosurface of a step of the transfer function is inside for a length whose
///           error is the square root of the field's error. If the field is level + a (u - u0)^2, a rounding error of
///           1e-7 creates or moves crossings by 3e-4. Knots that lanes cannot distinguish are also a step; the step's
///           height is the variation of the function between them.
/// Ramps     Where the function is steep, the error of the field has an effect along a ray's whole path there. Rounding
///           errors of positions and field differ from voxel to voxel: an eighth of their bound adds up as a sum of
///           squares, and a sixteenth linearly (measured on random grids and narrow peaks, docs/ACCURACY.md). Rounding
///           errors of knots are the same at each crossing.
/// Ends      The positions where a ray enters or leaves dense matter at a plane of the volume, of cell data or of the
///           view also have errors.
struct LaneErrorBound {
  /// Indexed by edge of the table (LaneTable::edge), with the length of a row of the table: the difference of light and
  /// opacity, per unit of length, between the two sides of the edge; 0 where it is negligible. Empty if all differences
  /// are negligible.
  std::vector<float> step;
  /// For edges with nonzero `step`: the difference of extinction, the colour of the denser side, and the remaining
  /// difference of light.
  std::vector<float> step_extinction, step_red, step_green, step_blue, step_light;
  /// One flag per edge: whether lane scalars and the edge are exact. If all samples of a voxel are then on one side of
  /// the edge, or on the edge, so is the field, which is always within the range of the voxel's samples.
  std::vector<std::uint8_t> sharp;
  /// One value per interval of the table: the error of light and opacity per unit of length due to rounding in a voxel.
  /// Values are zero, and the list is empty, in the same cases as for `step`.
  std::vector<float> ramp;
  float steady = 0;  ///< largest ratio, over all intervals, of the linearly accumulated part to `ramp`
  /// For intervals with nonzero `ramp`: the error of extinction and of colour.
  std::vector<float> ramp_extinction, ramp_color;
  bool ends = false;    ///< whether matter is dense enough for errors of ends to count
  float most = 1;       ///< largest error of light or opacity at one position
  float brightest = 1;  ///< upper bound of the light or opacity behind a position
  float noise = 0;      ///< error of the field in float lanes, in lane scalars
  float matters = 0;    ///< smallest error of a voxel for which the voxel is evaluated closely

  LaneErrorBound() = default;
  LaneErrorBound(const scene::TransferFunction& function, const integrals::LaneTable& table, const CellRanges& ranges,
                 const ErrorBoundSettings& settings);

  [[nodiscard]] bool any() const { return ends || !step.empty() || !ramp.empty(); }

 private:
  void find_noise(const CellRanges& ranges, bool cell_data);
  void find_sharp_edges(const integrals::LaneTable& table, const LaneSamples& lanes);
  void find_steps(const scene::TransferFunction& function, const integrals::LaneTable& table,
                  const ErrorBoundSettings& settings);
  void find_ramps(const integrals::LaneTable& table, const std::vector<double>& moved,
                  const ErrorBoundSettings& settings);
};

/// A ray whose light in float lanes is uncertain. It must be cast again in double precision (voxel_cast.hpp) between
/// two planar depths; from -infinity to infinity is the whole volume.
struct UncertainRay {
  int x, y;
  double z_begin, z_end;
  float error_bound;
};

}  // namespace tessera::volume
