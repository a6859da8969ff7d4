// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "readers/vtk/grid_numbers.hpp"
#include "readers/vtk/netcdf/netcdf_file.hpp"

namespace tessera::readers {

/// A variable's numbers after applying the attributes of the NetCDF Users Guide and CF 2.5.1 and 8.1: `_Unsigned`,
/// `scale_factor` and `add_offset`; NaN replaces `_FillValue` (for types larger than a byte the default one, if the
/// variable has none), `missing_value` and values outside `valid_range`, `valid_min` and `valid_max`. Numbers keep
/// their type unless one of these changes them.
struct NetcdfValues {
  GridNumbers numbers;
  std::uint64_t default_fills = 0, out_of_range = 0;  ///< samples that are NaN although no attribute names their value
};

/// Numbers from `first` on, `counts` along each dimension, in file order. Throws Error(bad_input) if they cannot be
/// read.
NetcdfValues read_values(const NetcdfFile& file, const NetcdfVariable& variable, std::span<const std::size_t> first,
                         std::span<const std::size_t> counts);

/// All numbers of a variable of at most `most`; empty if it has more.
GridNumbers read_whole(const NetcdfFile& file, const NetcdfVariable& variable, std::size_t most);

}  // namespace tessera::readers
