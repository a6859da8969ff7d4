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

/// Which dimensions of a variable are spatial axes. The other dimensions are steps: time, ensemble members and any
/// others; the last of them is the fastest.
struct AxisOrder {
  GridAxes along{};
  std::vector<std::size_t> steps;
};

/// Returns the role that a coordinate variable's attributes state, or else the one that its name suggests.
AxisRole role_of(const NetcdfFile& file, const NetcdfVariable& coordinate);

/// Returns the variable with the coordinates of a dimension: the variable with the same name, otherwise a variable that
/// `coordinates` names and that has only this dimension. Null if there is none.
const NetcdfVariable* coordinate_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                    const NetcdfDimension& dimension);

/// Returns the variables that are listed in the attribute `coordinates` of `variable`.
std::vector<const NetcdfVariable*> named_coordinates(const NetcdfFile& file, const NetcdfVariable& variable);

/// Determines the axes from the attributes of the dimensions' coordinates, the most reliable attributes first. If some
/// of z, y and x remain unidentified, they are the last of the unidentified dimensions, in this order. No value if a
/// variable has fewer than three spatial dimensions.
std::optional<AxisOrder> axes_of(const NetcdfFile& file, const NetcdfVariable& variable);

/// Whether a vertical coordinate increases downwards (CF 4.3). The attribute `positive` determines this; without it,
/// pressure, depth and sigma are taken to increase downwards, because they are 0 or smallest at the top.
bool counts_downwards(const NetcdfFile& file, const NetcdfVariable& coordinate);

}  // namespace tessera::readers
