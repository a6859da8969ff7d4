// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "tessera/file_formats.hpp"

namespace tessera::io {

/// Families of files that are read alike.
enum class FileKind : std::uint8_t {
  vtk_xml,     ///< meshes, and lists of data sets
  vtk_legacy,  ///< meshes
  amr,         ///< with levels of refinement; FormatRow::reader
  vtk_grid,    ///< image data and rectilinear grids, XML or legacy
  exodus,      ///< NetCDF; in HDF5 see hdf5
  hdf5,        ///< Exodus, CGNS, VTKHDF, NetCDF or MINC 2: the helper looks
  netcdf,      ///< grids; in HDF5 see hdf5
  minc,        ///< MINC 1
  xdmf,        ///< grids and meshes
  med,         ///< by its name: in HDF5, of which the beginning says nothing
  solver,      ///< FormatRow::reader
  gmsh,        ///< what Gmsh's library reads; FormatRow::reader
  medit_text,
  medit,  ///< binary
  nastran,
  su2,
  tecplot,
  plot3d,
  plot3d_list,
  tetgen_mesh,     ///< .node and .ele
  tetgen_surface,  ///< .poly and .smesh
  stl,
  vtk_surface,
  ply,
  tets,
  pvd,  ///< and .series
  meta_image,
  nrrd,
  nifti,
  analyze,  ///< 7.5, or a NIfTI pair named by its .img
  dicom,    ///< a file, or a folder of them
  bricks,
  raw,
  unread  ///< known, and not read
};

/// What a file begins with, of a gzip file what it holds.
struct FileBeginning {
  const std::filesystem::path& file;
  std::string_view text;   ///< its first bytes, at most 4096
  std::uint64_t size = 0;  ///< of the whole; 0 if it is compressed
};

enum class Needs : std::uint8_t { nothing, vtk, tetgen, vtk_and_tetgen, gmsh, dicom, xdmf, med };

/// A row of the one table of formats. What is listed, what a name means and what a beginning means all come from it.
struct FormatRow {
  FileKind kind;
  const char* name;
  const char* extensions;  ///< in lower case, with blanks between; the first is what writers use
  FileHolds holds;
  Needs needs;
  const char* remark;                    ///< what applies, limits; why it is not read
  bool (*begins)(const FileBeginning&);  ///< null: nothing tells it but its name
  const char* reader = "";      ///< of FileKind::solver, amr and gmsh: a name in the main file of a program in readers/
  bool has_time_steps = false;  ///< ReadOptions::time_step applies
  enum class Listed : bool { no, yes } listed = Listed::yes;
};

std::span<const FormatRow> format_rows();

/// What a file is: by what it begins with; MED files, which begin as other HDF5, by that and their name; where that
/// tells nothing, or the file is not there, by its name; null if that tells nothing either. A folder is an OpenFOAM
/// case, an AMReX plot file, of DICOM files, or nothing.
const FormatRow* format_of(const std::filesystem::path& file);

/// By what it begins with alone; null if that tells nothing.
const FormatRow* format_begun(const std::filesystem::path& file);

/// By its name alone, in which a last .gz does not count.
const FormatRow* format_named(const std::filesystem::path& file);

/// bad_input: its format is not known, or known and not read, or what is no mesh (no volume) is asked for as one.
[[noreturn]] void refuse_as_mesh(const std::filesystem::path& file);

}  // namespace tessera::io
