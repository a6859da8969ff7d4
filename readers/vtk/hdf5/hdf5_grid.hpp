// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readers/common/holdings.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"

namespace tessera::readers {

/// Whether a file has arrays of numbers of three or more dimensions.
bool holds_arrays(const Hdf5File& file);

/// Arrays of an HDF5 file that follows no convention: a regular grid of unit steps, z slowest and x fastest, of the
/// arrays of one size; notes name the others. Fields are named by their paths. A last dimension of two to four contains
/// components, the first of other ones steps.
io::ForeignContents read_arrays(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                const nlohmann::json& request);

/// A VTKHDF file of type ImageData, according to VTK's file format documentation; arrays may have a first dimension of
/// steps.
io::ForeignContents read_vtk_hdf_image(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                       const nlohmann::json& request);

}  // namespace tessera::readers
