// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readers/common/holdings.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"

namespace tessera::readers {

/// VTKHDF of the type UnstructuredGrid at one of its time steps. VTK 9.1 does not know steps.
///
/// Source  "VTKHDF format specification", VTK's documentation, version 2.5: parts one after the other, of a step those
///         from Steps/PartOffsets on, as many as Steps/NumberOfParts; its points, cells and connectivity from
///         Steps/PointOffsets, CellOffsets and ConnectivityIdOffsets on, its arrays from Steps/PointDataOffsets and
///         CellDataOffsets on where these have them. `Offsets` has one number more than cells for each part.
io::ForeignContents read_vtk_hdf_mesh(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                      const nlohmann::json& request);

}  // namespace tessera::readers
