// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace tessera::readers {

/// The bytes that an open NetCDF classic file (versions 1, 2 and 5) has at least if it is whole, by its header ("NetCDF
/// Classic Format Specification", Unidata): NetCDF's library reads what lies behind a file's end as zeros. 0 for
/// NetCDF-4, which is HDF5 and tells by itself, and where the header cannot be read.
std::uint64_t least_netcdf_bytes(int file);

}  // namespace tessera::readers
