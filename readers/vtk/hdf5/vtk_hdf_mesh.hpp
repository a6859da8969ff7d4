// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readers/common/holdings.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"

namespace tessera::readers {

/// A VTKHDF file of type UnstructuredGrid at one of its time steps, which VTK 9.1 does not support.
///
/// Source  "VTKHDF format specification", VTK's documentation, version 2.5: parts one after the other; those of a step
///         start at Steps/PartOffsets and are as many as Steps/NumberOfParts. Its points, cells and connectivity start
///         at Steps/PointOffsets, CellOffsets and ConnectivityIdOffsets, its arrays at Steps/PointDataOffsets and
///         CellDataOffsets if these have them. `Offsets` has one number more than cells for each part.
io::ForeignContents read_vtk_hdf_mesh(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                      const nlohmann::json& request);

}  // namespace tessera::readers
