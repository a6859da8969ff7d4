// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "readers/common/holdings.hpp"
#include "readers/vtk/hdf5/hdf5_file.hpp"

namespace tessera::readers {

/// Whether a file has arrays of numbers of three dimensions or more.
bool holds_arrays(const Hdf5File& file);

/// Arrays of HDF5 that follows no convention: a regular grid of unit steps, z the slowest and x the fastest, of those
/// that are of one size; the others are named in notes. Fields are named by their paths. A last dimension of two to
/// four is one of components, the first of others are steps.
io::ForeignContents read_arrays(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                const nlohmann::json& request);

/// VTKHDF of the type ImageData, by VTK's file format documentation; arrays may have a first dimension of steps.
io::ForeignContents read_vtk_hdf_image(Holdings& holdings, const Hdf5File& file, const std::string& source,
                                       const nlohmann::json& request);

}  // namespace tessera::readers
