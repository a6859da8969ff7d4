// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/foreign/client/foreign_file.hpp"
#include "io/volume/volume_options.hpp"
#include "io/volume/volume_reader.hpp"

namespace tessera::io {

/// Converts the only part of a file, an image or a rectilinear grid, to a volume in memory. Rectilinear grids that are
/// uniform up to rounding become regular. Throws Error(bad_input) for other parts and for fields whose size does not
/// match the grid.
VolumeFile grid_of(const ForeignFile& opened, const VolumeOptions& options);

}  // namespace tessera::io
