// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "readers/vtk/grid_numbers.hpp"
#include "readers/vtk/netcdf/netcdf_file.hpp"

namespace tessera::readers {

/// A variable's numbers after applying the attributes of the NetCDF Users Guide and CF 2.5.1 and 8.1: `_Unsigned`,
/// `scale_factor` and `add_offset`. NaN replaces numbers that are equal to `_FillValue` or `missing_value`, or outside
/// `valid_range`, `valid_min` and `valid_max`. A variable without `_FillValue` has the default fill value, if its type
/// is larger than a byte. Numbers keep their type unless one of these attributes changes them.
struct NetcdfValues {
  GridNumbers numbers;
  std::uint64_t default_fills = 0, out_of_range = 0;  ///< number of samples that became NaN because of the default fill
                                                      ///< value or a valid range
};

/// Reads numbers from index `first` on, `counts` along each dimension, in file order. Throws Error(bad_input) if they
/// cannot be read.
NetcdfValues read_values(const NetcdfFile& file, const NetcdfVariable& variable, std::span<const std::size_t> first,
                         std::span<const std::size_t> counts);

/// Reads all numbers of a variable; empty if there are more than `most`.
GridNumbers read_whole(const NetcdfFile& file, const NetcdfVariable& variable, std::size_t most);

}  // namespace tessera::readers
