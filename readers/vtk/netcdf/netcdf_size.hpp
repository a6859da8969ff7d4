// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::readers {

/// The minimum size in bytes of a complete NetCDF classic file (versions 1, 2 and 5) with this header ("NetCDF Classic
/// Format Specification", Unidata): NetCDF's library reads zeros beyond a file's end. 0 for NetCDF-4, which is HDF5 and
/// detects it itself, and if the header cannot be read.
std::uint64_t least_netcdf_bytes(int file);

}  // namespace tessera::readers
