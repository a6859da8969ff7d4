// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "readers/vtk/grid_numbers.hpp"
#include "readers/vtk/netcdf/netcdf_file.hpp"

namespace tessera::readers {

/// The role of an axis according to the CF conventions (4 and 5), Unidata's attribute `_CoordinateAxisType`, COARDS and
/// common names.
enum class AxisRole : std::uint8_t { x, y, z, time, member, unknown };

/// Which dimensions of a variable are spatial axes. The others are steps: time, ensemble members and any others, the
/// last the fastest.
struct AxisOrder {
  GridAxes along{};
  std::vector<std::size_t> steps;
};

/// The role given by a coordinate variable's attributes, or else by its name.
AxisRole role_of(const NetcdfFile& file, const NetcdfVariable& coordinate);

/// The variable with a dimension's coordinates: the one of the same name, else one with only this dimension that
/// `coordinates` names. Null if there is none.
const NetcdfVariable* coordinate_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                    const NetcdfDimension& dimension);

/// The variables that a variable's attribute `coordinates` names.
std::vector<const NetcdfVariable*> named_coordinates(const NetcdfFile& file, const NetcdfVariable& variable);

/// Determined by the attributes of the dimensions' coordinates, the strongest first; the missing ones of z, y and x, in
/// this order, are the last of the unidentified dimensions. No value if a variable has fewer than three spatial
/// dimensions.
std::optional<AxisOrder> axes_of(const NetcdfFile& file, const NetcdfVariable& variable);

/// Whether a vertical coordinate increases downwards: CF 4.3. `positive` decides; otherwise pressure, depth and sigma
/// do, which are 0 or smallest at the top.
bool counts_downwards(const NetcdfFile& file, const NetcdfVariable& coordinate);

}  // namespace tessera::readers
