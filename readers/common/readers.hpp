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

/// What the helper reads, each with the words of a request beside its file. All throw Error(bad_input) in one line.
namespace tessera::readers {

/// VTK's XML files but unstructured grids in pieces; `type` is that of <VTKFile>. The pieces of the others have to fill
/// the whole.
io::ForeignContents read_vtk_xml(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Legacy VTK, all its arrays.
io::ForeignContents read_vtk_legacy(Holdings& holdings, const std::filesystem::path& file,
                                    const nlohmann::json& request);

/// VTK's XML HyperTreeGrids: the leaves that no mask hides. A file without any has no part.
io::ForeignContents read_hyper_trees(Holdings& holdings, const std::filesystem::path& file,
                                     const nlohmann::json& request);

/// PLOT3D; `q` is the solution file or empty, the rest is the layout (io/mesh/plot3d_layout.hpp).
io::ForeignContents read_plot3d(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// STL surfaces.
io::ForeignContents read_stl(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// VTK surfaces, XML or legacy; strips as triangles after the other polygons.
io::ForeignContents read_vtk_surface(Holdings& holdings, const std::filesystem::path& file,
                                     const nlohmann::json& request);

/// Exodus II: all element blocks, nodal and element variables at `time_step`, counted from 0, or the last one. Nodes
/// are where they began. Variables NAME_x NAME_y NAME_z become one vector NAME.
io::ForeignContents read_exodus(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// A grid of NetCDF variables of three dimensions, by the CF conventions where it follows them: rectilinear axes as
/// they stand (degrees too), else hexahedra. The grid that has `field`, else the one with the most variables;
/// `time_step` as of Exodus; missing values are NaN. With `look` the kind of grid alone.
io::ForeignContents read_netcdf(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Whether a file that NetCDF's library can open has such a grid.
bool holds_netcdf_grid(const std::filesystem::path& file);

/// MINC 1, `time_step` as of Exodus; real values, in the space that the direction cosines give.
io::ForeignContents read_minc(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// The same of MINC 2. Of a build without MINC's library (CMake option TESSERA_MINC) it throws Error(bad_input).
io::ForeignContents read_minc2(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// HDF5, by what is in it: Exodus, CGNS, FLASH, VTKHDF, or a grid as read_netcdf() and MINC 2. With `look` no more than
/// the kind of a grid, of others nothing.
io::ForeignContents read_hdf5(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// OpenFOAM: the case that a folder is or a file lies in, which may be empty. Put together, or as its processors left
/// it.
io::ForeignContents read_openfoam(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// EnSight 6 and Gold, by the .case file.
io::ForeignContents read_ensight(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

io::ForeignContents read_cgns(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

io::ForeignContents read_avs_ucd(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_fluent(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_gambit(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// FLASH, a file of HDF5, and Enzo, by its .hierarchy or .boundary: blocks of all levels, their cell data.
io::ForeignContents read_flash(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);
io::ForeignContents read_enzo(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// Fills a surface by TetGen (cells/surface.hpp).
io::ForeignContents fill_surface(Holdings& holdings, const std::filesystem::path& file, const nlohmann::json& request);

/// More memory and time for a file that is about to be read.
void allow_for(const std::filesystem::path& file);

/// For several, together.
void allow_for_files(std::span<const std::filesystem::path> files);

/// For all that lies in a folder and below: of formats that are many files.
void allow_for_folder(const std::filesystem::path& folder, bool is_compressed = false);

/// For a surface of so many facets that is about to be filled with about so many tets; more where the user has
/// `chosen` them.
void allow_filling(std::size_t facets, double tets, bool is_chosen);

/// What to say where memory ran out: the file's counts may be wrong, if it had all that its size can explain, else the
/// machine is too small.
scene::Error memory_error(const std::string& source,
                          std::string_view damage =
                              "it asks for more memory than a file of its size can need; its "
                              "counts may be wrong: have it written again, or in another format");

}  // namespace tessera::readers
