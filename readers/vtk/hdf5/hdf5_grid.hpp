// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readers/common/holdings.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"

namespace tessera::readers {

/// Whether a file has arrays of numbers of three or more dimensions.
bool holds_arrays(const Hdf5File& file);

/// Reads arrays of an HDF5 file that does not follow any convention. All arrays of one size become fields of a regular
/// grid of unit steps, z slowest and x fastest; notes name the other arrays. Fields are named by their paths. If there
/// are more than three dimensions, a last dimension of length two to four contains components, and the first of the
/// other additional dimensions contains steps.
io::ForeignContents read_arrays(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                const nlohmann::json& request);

/// Reads a VTKHDF file of type ImageData, as VTK's file format documentation defines it. Arrays may have a first
/// dimension for steps.
io::ForeignContents read_vtk_hdf_image(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                       const nlohmann::json& request);

}  // namespace tessera::readers
