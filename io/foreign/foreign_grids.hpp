// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "io/foreign/client/foreign_file.hpp"
#include "io/volume/volume_options.hpp"
#include "io/volume/volume_reader.hpp"

namespace tessera::io {

/// The only part of a file, an image or a rectilinear grid, as a volume in memory; rectilinear grids that are uniform
/// up to rounding become regular. Throws Error(bad_input) for other parts and for fields that do not fit.
VolumeFile grid_of(const ForeignFile& opened, const VolumeOptions& options);

}  // namespace tessera::io
