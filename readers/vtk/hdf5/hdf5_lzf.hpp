// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::readers {

/// Registers the filter lzf (32000) with HDF5's library, which does not include it; h5py writes it.
void register_lzf();

}  // namespace tessera::readers
