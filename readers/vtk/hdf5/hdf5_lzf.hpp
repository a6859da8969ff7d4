// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tessera::readers {

/// Has HDF5's library undo the filter lzf (32000), which h5py brings and the library does not know.
void register_lzf();

}  // namespace tessera::readers
