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

/// The readers of the helper, each with the options of a request in addition to its file. All throw Error(bad_input) in
/// one line.
namespace tessera::readers {

/// VTK's XML files except unstructured grids in pieces; `type` is that of <VTKFile>. The pieces of other data sets must
/// fill the whole.
io::ForeignContents read_vtk_xml(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Legacy VTK, with all arrays.
io::ForeignContents read_vtk_legacy(Holdings& holdings, const std::filesystem::path& file,
                                    const nlohmann::json& request);

/// VTK's XML HyperTreeGrids: the leaves that no mask hides. A file without leaves has no part.
io::ForeignContents read_hyper_trees(Holdings& holdings, const std::filesystem::path& file,
                                     const nlohmann::json& request);

/// PLOT3D; `q` is the solution file or empty, the other options are the layout (io/mesh/plot3d_layout.hpp).
io::ForeignContents read_plot3d(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// STL surfaces.
io::ForeignContents read_stl(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// VTK surfaces, XML or legacy; strips become triangles after the other polygons.
io::ForeignContents read_vtk_surface(Holdings& holdings, const std::filesystem::path& file,
                                     const nlohmann::json& request);

/// Exodus II: all element blocks, nodal and element variables at `time_step`, counted from 0, or the last one. Nodes
/// keep their original positions. Variables NAME_x NAME_y NAME_z become one vector NAME.
io::ForeignContents read_exodus(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// A grid of NetCDF variables of three dimensions, by the CF conventions if the file follows them: rectilinear axes
/// unchanged (also degrees), else hexahedra. Reads the grid that has `field`, else the one with the most variables;
/// `time_step` as for Exodus; missing values are NaN. With `look` only the kind of grid.
io::ForeignContents read_netcdf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Whether a file that NetCDF's library can open has such a grid.
bool holds_netcdf_grid(const std::filesystem::path& file);

/// MINC 1, `time_step` as for Exodus; real values, in the space of the direction cosines.
io::ForeignContents read_minc(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// The same for MINC 2. In a build without MINC's library (CMake option TESSERA_MINC) it throws Error(bad_input).
io::ForeignContents read_minc2(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// HDF5, by its content: Exodus, CGNS, FLASH, VTKHDF, MINC 2, or a grid as in read_netcdf(). With `look` only the kind
/// of a grid, and nothing for others.
io::ForeignContents read_hdf5(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// OpenFOAM: the case that is a directory or contains a file, which may be empty. Reconstructed or decomposed by
/// processors.
io::ForeignContents read_openfoam(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// EnSight 6 and Gold, by the .case file.
io::ForeignContents read_ensight(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

io::ForeignContents read_cgns(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

io::ForeignContents read_avs_ucd(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_fluent(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_gambit(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// FLASH, an HDF5 file, and Enzo, by its .hierarchy or .boundary: blocks of all levels, with cell data.
io::ForeignContents read_flash(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_enzo(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Fills a surface by TetGen (cells/surface.hpp).
io::ForeignContents fill_surface(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Raises the limits of memory and time for a file that is about to be read.
void allow_for(const std::filesystem::path& file);

/// The same for several files together.
void allow_for_files(std::span<const std::filesystem::path> files);

/// The same for all files in a directory tree, for formats of many files.
void allow_for_folder(const std::filesystem::path& folder, bool is_compressed = false);

/// The same for filling a surface of `facets` facets with about `tets` tets; more if the user chose their number.
void allow_filling(std::size_t facets, double tets, bool is_chosen);

/// The error if memory runs out: the file's counts may be wrong if it had all memory that its size can explain;
/// otherwise the machine is too small.
scene::Error memory_error(const std::string& source,
                          std::string_view damage =
                              "it asks for more memory than a file of its size can need; its "
                              "counts may be wrong: have it written again, or in another format");

}  // namespace tessera::readers
