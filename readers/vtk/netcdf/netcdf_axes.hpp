// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "readers/vtk/grid_numbers.hpp"
#include "readers/vtk/netcdf/netcdf_file.hpp"

namespace tessera::readers {

/// What an axis is, by the CF conventions (4 and 5), Unidata's attribute `_CoordinateAxisType`, COARDS and common
/// names.
enum class AxisRole : std::uint8_t { x, y, z, time, member, unknown };

/// Which dimensions of a variable are axes of space. The others are steps: time, members of an ensemble and what else
/// there is, the last the fastest.
struct AxisOrder {
  GridAxes along{};
  std::vector<std::size_t> steps;
};

/// What a coordinate variable's attributes say that it is, else its name.
AxisRole role_of(const NetcdfFile& file, const NetcdfVariable& coordinate);

/// The variable of a dimension's coordinates: the one of its name, else one of this dimension alone that `coordinates`
/// names. Null if it has none.
const NetcdfVariable* coordinate_of(const NetcdfFile& file, const NetcdfVariable& variable,
                                    const NetcdfDimension& dimension);

/// The variables that a variable's attribute `coordinates` names.
std::vector<const NetcdfVariable*> named_coordinates(const NetcdfFile& file, const NetcdfVariable& variable);

/// By the attributes of the dimensions' coordinates, the strongest first; the last of the dimensions of which nothing
/// is known are those that are missing of z, y and x, in this order. Nothing if a variable has fewer than three in
/// space.
std::optional<AxisOrder> axes_of(const NetcdfFile& file, const NetcdfVariable& variable);

/// Whether a vertical coordinate counts downwards: CF 4.3. `positive` decides, else pressure, depth and sigma, which
/// are 0 or least at the top, do.
bool counts_downwards(const NetcdfFile& file, const NetcdfVariable& coordinate);

}  // namespace tessera::readers
