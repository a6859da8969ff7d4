// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "readers/vtk/netcdf/netcdf_axes.hpp"
#include "readers/vtk/netcdf/netcdf_file.hpp"

namespace tessera::readers {

/// Horizontal coordinates of two dimensions: CF 5.2 and 5.6.
struct CurvedCoordinates {
  const NetcdfVariable* x = nullptr;
  const NetcdfVariable* y = nullptr;
};

/// Those of a variable, by its attribute `coordinates`, else by that of another one of the same dimensions, else those
/// of these dimensions that are longitude and latitude. Nothing if there are none.
std::optional<CurvedCoordinates> curved_coordinates_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                                       const AxisOrder& order);

/// Points of a curvilinear grid, x fastest. Values belong to the points, or, where coordinates have bounds, to cells.
struct CurvedGrid {
  std::array<std::size_t, 3> points{};
  std::vector<double> positions;
  bool has_cells = false;
};

/// `z` has the heights of the variable's levels, `z_bounds` those between them, of which there is one more. Coordinates
/// with steps are those of `step_indices`, one for each of order.steps.
CurvedGrid curved_grid(const NetcdfFile& file, const NetcdfVariable& variable, const AxisOrder& order,
                       std::span<const std::size_t> step_indices, const CurvedCoordinates& coordinates,
                       std::span<const double> z, std::span<const double> z_bounds, std::vector<std::string>& notes);

}  // namespace tessera::readers
