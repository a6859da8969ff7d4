// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>

#include "cells/surface.hpp"
#include "io/foreign/messages/foreign_data.hpp"
#include "readers/common/holdings.hpp"
#include "scene/error.hpp"

/// The readers of the helper. Each takes a file and the options of a request. All throw Error(bad_input) with a message
/// of one line.
namespace tessera::readers {

/// Reads VTK's XML files, except unstructured grids in pieces. `type` of the request is that of <VTKFile>. The pieces
/// of other data sets must fill the whole extent.
io::ForeignContents read_vtk_xml(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads legacy VTK files, with all arrays.
io::ForeignContents read_vtk_legacy(Holdings& holdings, const std::filesystem::path& file,
                                    const nlohmann::json& request);

/// Reads VTK's XML HyperTreeGrids: the leaves that no mask hides. A file without leaves gives no part.
io::ForeignContents read_hyper_trees(Holdings& holdings, const std::filesystem::path& file,
                                     const nlohmann::json& request);

/// Reads PLOT3D. In the request, `q` is the solution file or empty; the other options are the layout
/// (io/mesh/plot3d_layout.hpp).
io::ForeignContents read_plot3d(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// STL surfaces.
io::ForeignContents read_stl(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads VTK surfaces, XML or legacy. Strips become triangles, which follow the other polygons.
io::ForeignContents read_vtk_surface(Holdings& holdings, const std::filesystem::path& file,
                                     const nlohmann::json& request);

/// Reads Exodus II: all element blocks, and the nodal and element variables at `time_step`, counted from 0, or the last
/// step. Nodes keep their original positions. Variables NAME_x NAME_y NAME_z become one vector NAME.
io::ForeignContents read_exodus(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads a grid of NetCDF variables of three dimensions, using the CF conventions if the file follows them. Rectilinear
/// axes are kept, even if they are in degrees; other grids become hexahedra. Reads the grid that has `field`, otherwise
/// the one with the most variables; `time_step` is as for Exodus. Missing values become NaN. With `look`, reports only
/// the kind of grid.
io::ForeignContents read_netcdf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Whether a file that NetCDF's library can open has a grid that read_netcdf() reads.
bool holds_netcdf_grid(const std::filesystem::path& file);

/// Reads MINC 1, with `time_step` as for Exodus: real values, in the space of the direction cosines.
io::ForeignContents read_minc(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads MINC 2 like read_minc(). In a build without MINC's library (CMake option TESSERA_MINC) it throws
/// Error(bad_input).
io::ForeignContents read_minc2(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads HDF5, whose content determines the kind of file: Exodus, CGNS, FLASH, VTKHDF, MINC 2, or a grid as in
/// read_netcdf(). With `look`, reports only the kind of a grid, and nothing for other files.
io::ForeignContents read_hdf5(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads an OpenFOAM case, reconstructed or decomposed by processors. `file` is the directory of the case, or a file in
/// it, which may be empty.
io::ForeignContents read_openfoam(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Reads EnSight 6 and Gold, given the .case file.
io::ForeignContents read_ensight(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

io::ForeignContents read_cgns(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

io::ForeignContents read_avs_ucd(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_fluent(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_gambit(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Read FLASH, an HDF5 file, and Enzo, given its .hierarchy or .boundary: the blocks of all levels, with cell data.
io::ForeignContents read_flash(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_enzo(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Fills a surface by TetGen (cells/surface.hpp).
io::ForeignContents fill_surface(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Raises the limits of memory and time for a file that is about to be read.
void allow_for(const std::filesystem::path& file);

/// Raises the limits of memory and time for several files that are read together.
void allow_for_files(std::span<const std::filesystem::path> files);

/// Raises the limits of memory and time for all files in a directory tree, for formats that consist of many files.
void allow_for_folder(const std::filesystem::path& folder, bool is_compressed = false);

/// Raises the limits of memory and time for filling a surface of `facets` facets with about `tets` tets. The limits are
/// higher if the user chose that number.
void allow_filling(std::size_t facets, double tets, bool is_chosen);

/// Returns the error if memory runs out. If the process had as much memory as a sound file of this size can need, the
/// file's counts may be wrong; otherwise the machine has too little memory.
scene::Error memory_error(const std::string& source,
                          std::string_view damage =
                              "it requires more memory than a file of its size can need, so its counts may be wrong; "
                              "write the file again, or in another format");

}  // namespace tessera::readers
