// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::readers {

/// Registers the filter lzf (32000) with the HDF5 library. h5py writes this filter, and the library does not include
/// it.
void register_lzf();

}  // namespace tessera::readers
