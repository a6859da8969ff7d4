// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "io/mesh/amr_opened.hpp"

namespace tessera::io {

/// Opens a plot file of AMReX (BoxLib), given the directory or the file Header in it. All levels and fields are read;
/// particles are left out. Values are mapped. The parser is our own, because the parser of VTK 9.1 reads missing values
/// of truncated files as zeros, counts bytes in 32 bits and misplaces domains that do not begin at cell 0.
///
/// Source  AMReX documentation, "Plotfile format"; Src/Base/AMReX_VisMF.cpp and AMReX_FabConv.cpp for the lists of
///         boxes and the formats of numbers.
OpenedAmr open_amrex(const std::filesystem::path& file);

}  // namespace tessera::io
