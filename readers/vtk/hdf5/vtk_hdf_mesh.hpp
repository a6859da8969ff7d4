// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readers/common/holdings.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"

namespace tessera::readers {

/// Reads a VTKHDF file of type UnstructuredGrid at one of its time steps, which VTK 9.1 does not support.
///
/// Source  "VTKHDF format specification", VTK's documentation, version 2.5: parts are stored one after the other; those
///         of a step start at Steps/PartOffsets, and Steps/NumberOfParts is their number. The points, cells and
///         connectivity of a step start at Steps/PointOffsets, CellOffsets and ConnectivityIdOffsets, and its arrays at
///         Steps/PointDataOffsets and CellDataOffsets if these exist. For each part, `Offsets` has one number more than
///         there are cells.
io::ForeignContents read_vtk_hdf_mesh(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                      const nlohmann::json& request);

}  // namespace tessera::readers
