// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::readers {

/// Returns the smallest size in bytes of a complete NetCDF classic file (versions 1, 2 and 5) with this header ("NetCDF
/// Classic Format Specification", Unidata). Needed because NetCDF's library reads zeros beyond the end of a file. 0 if
/// the header cannot be read, and for NetCDF-4, because HDF5 detects truncated files itself.
std::uint64_t least_netcdf_bytes(int file);

}  // namespace tessera::readers
