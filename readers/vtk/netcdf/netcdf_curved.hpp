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

/// Horizontal coordinates with two dimensions: CF 5.2 and 5.6.
struct CurvedCoordinates {
  const NetcdfVariable* x = nullptr;
  const NetcdfVariable* y = nullptr;
};

/// Returns the coordinates of a variable: those that its attribute `coordinates` names, otherwise those that another
/// variable of the same dimensions names, otherwise the longitude and latitude of these dimensions. No value if there
/// are none.
std::optional<CurvedCoordinates> curved_coordinates_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                                       const AxisOrder& order);

/// Points of a curvilinear grid, x fastest. Values belong to the points or, if coordinates have bounds, to the cells.
struct CurvedGrid {
  std::array<std::size_t, 3> points{};
  std::vector<double> positions;
  bool has_cells = false;
};

/// Creates the grid. `z` contains the heights of the variable's levels, and `z_bounds` the heights of the boundaries of
/// these levels, which is one more value. If coordinates depend on the step, `step_indices` selects the step, with an
/// index for each entry of order.steps.
CurvedGrid curved_grid(const NetcdfFile& file, const NetcdfVariable& variable, const AxisOrder& order,
                       std::span<const std::size_t> step_indices, const CurvedCoordinates& coordinates,
                       std::span<const double> z, std::span<const double> z_bounds, std::vector<std::string>& notes);

}  // namespace tessera::readers
