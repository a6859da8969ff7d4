// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "integrals/lane_table.hpp"
#include "volume/bricks/cell_ranges.hpp"

namespace tessera::volume {

/// What LaneErrorBound is told of a frame.
struct ErrorBoundSettings {
  bool cell_data = false;
  double largest_color = 1;
  double brightest = 1;  ///< light that may come along a ray
  double least = 0;      ///< errors of light or opacity that do not matter
  double longest = 1;    ///< of a ray in a voxel, in the table's unit
  double unit = 1;       ///< of lengths of the table, world units
};

/// Where float lanes cannot tell a ray's light to the accuracy asked: rays of which that may be are cast again in
/// double precision (voxel_cast.hpp). Lanes add up what such places may err (ray_piece-inl.h).
///
/// Excess  what is there too much of a medium of colour c, optical depth e, at a place to which T gets through and
///         which light I comes to from behind, changes light by T e (c - I) and opacity by e times what the whole ray
///         lets through: little in front of, or inside, dense matter of the same colour.
/// Steps   a ray that all but touches the surface of a step of the transfer function sees it for a length whose
///         error is the square root of the field's: where that is level + a (u - u0)^2, rounding of 1e-7 makes or
///         moves crossings by 3e-4.
///         Knots that lanes do not tell apart are a step too, by all that the function is between them.
/// Ramps   where the function is steep, the field's error shows for as long as a ray stays there. Roundings of places
///         and field differ from voxel to voxel: an eighth of what they may be adds up as squares do, and a sixteenth
///         is alike (measured over random grids and where peaks are narrow, docs/ACCURACY.md).
///         Those of the knots are the same at each crossing.
/// Ends    where a ray enters or leaves dense matter at a plane of the volume, of cell data or of the view.
struct LaneErrorBound {
  /// By edge of the table (LaneTable::edge), as long as a row of it: the light and opacity, per unit of length, that
  /// differ between its two sides; 0 where that is too little to matter. Empty: no edge is a step.
  std::vector<float> step;
  /// Of the edges where `step` is not 0: difference of extinction, colour of the denser side, and the light that
  /// differs beside.
  std::vector<float> step_extinction, step_red, step_green, step_blue, step_light;
  /// By edge: whether lanes and edge are exact, so that where all of a voxel's samples are on one side of the edge, or
  /// on it, so is the field: it is never beyond its samples.
  std::vector<std::uint8_t> sharp;
  /// By interval of the table: error of light and opacity per unit of length that a voxel's rounding makes; 0 and empty
  /// as above.
  std::vector<float> ramp;
  float steady = 0;  ///< largest share of it that adds up, over all intervals
  /// Of the intervals where `ramp` is not 0: error of extinction, and of colour.
  std::vector<float> ramp_extinction, ramp_color;
  bool ends = false;    ///< whether matter is so dense that ends matter
  float most = 1;       ///< error of light or opacity that one place can make
  float brightest = 1;  ///< light or opacity that is behind a place at most
  float noise = 0;      ///< of the field in float lanes, lane scalars
  float matters = 0;    ///< what a voxel may err before it is looked at closely

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

/// A ray whose light float lanes are not sure of, to be cast again in double precision (voxel_cast.hpp) between two
/// planar depths, or wherever it is in the volume: from -infinity to infinity.
struct UncertainRay {
  int x, y;
  double z_begin, z_end;
  float error_bound;
};

}  // namespace tessera::volume
