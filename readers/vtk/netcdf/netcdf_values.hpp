// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "readers/vtk/grid_numbers.hpp"
#include "readers/vtk/netcdf/netcdf_file.hpp"

namespace tessera::readers {

/// A variable's numbers by the attributes of the NetCDF Users Guide and CF 2.5.1 and 8.1: `_Unsigned`, `scale_factor`
/// and `add_offset` apply, and NaN stands for `_FillValue` (of types of more than a byte the default one, where the
/// variable has none), `missing_value` and what is outside `valid_range`, `valid_min` and `valid_max`. Numbers keep
/// their type unless one of these changes them.
struct NetcdfValues {
  GridNumbers numbers;
  std::uint64_t default_fills = 0, out_of_range = 0;  ///< samples that are NaN, though no attribute names their value
};

/// Those from `first` on, `counts` along each dimension, in the order of the file. Throws Error(bad_input) if they
/// cannot be read.
NetcdfValues read_values(const NetcdfFile& file, const NetcdfVariable& variable, std::span<const std::size_t> first,
                         std::span<const std::size_t> counts);

/// All numbers of a variable of at most `most`; none if it has more.
GridNumbers read_whole(const NetcdfFile& file, const NetcdfVariable& variable, std::size_t most);

}  // namespace tessera::readers
