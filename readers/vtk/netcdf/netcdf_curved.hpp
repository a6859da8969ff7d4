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

/// The coordinates of a variable, by its attribute `coordinates`, else by that of another variable of the same
/// dimensions, else the longitude and latitude of these dimensions. No value if there are none.
std::optional<CurvedCoordinates> curved_coordinates_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                                       const AxisOrder& order);

/// Points of a curvilinear grid, x fastest. Values belong to the points or, if coordinates have bounds, to cells.
struct CurvedGrid {
  std::array<std::size_t, 3> points{};
  std::vector<double> positions;
  bool has_cells = false;
};

/// `z` has the heights of the variable's levels, `z_bounds` those between them, one more. Coordinates with steps use
/// those of `step_indices`, one per entry of order.steps.
CurvedGrid curved_grid(const NetcdfFile& file, const NetcdfVariable& variable, const AxisOrder& order,
                       std::span<const std::size_t> step_indices, const CurvedCoordinates& coordinates,
                       std::span<const double> z, std::span<const double> z_bounds, std::vector<std::string>& notes);

}  // namespace tessera::readers
