// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "io/foreign/client/foreign_file.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/volume/volume_reader.hpp"

/// Functions named by rows of the table of formats, for files that the reader programs read: as meshes and as volumes.
/// Some formats contain either, and only the formats' libraries can determine which. All functions throw
/// missing_reader() if the program is not installed.
namespace tessera::io {

/// The name of a reader, as a template argument. The names are defined in the programs' main files under readers/.
struct ReaderName {
  template <std::size_t n>
  consteval ReaderName(const char (&name)[n]) {  // NOLINT(google-explicit-constructor): literals convert to it
    std::copy_n(name, n, text);
  }
  char text[16]{};
};

/// A program under readers/, the name of a reader in it, and the remedy to report if it crashes.
struct ForeignReader {
  Reader program;
  const char* name;
  const char* remedy = nullptr;  ///< null: the remedy for other files
};

/// Reads all blocks and arrays of one time step, by default the last. Grids become hexahedra.
cells::MeshBlocks read_foreign_mesh(const InputFile& file, const ForeignReader& by, const MeshOptions& options);

/// Opens the file as a volume. Throws Error(bad_input) for a mesh, and for a file that is identified by its name alone.
/// Only DICOM files are opened in that case, because they may lack the DICM mark.
VolumeFile read_foreign_volume(const InputFile& file, const ForeignReader& by, const VolumeOptions& options);

/// Whether the file contains exactly one regular or rectilinear grid and so is a volume. The helper inspects the file's
/// header. Also false if the helper cannot read the file: opening it then reports why.
bool holds_one_grid(const InputFile& file, const ForeignReader& by);

/// Returns the time steps that the helper finds when it opens a mesh.
scene::TimeStepRead foreign_time_steps(const InputFile& file, const ForeignReader& by, const MeshOptions& options);

template <Reader program, ReaderName name>
cells::MeshBlocks mesh_by(const InputFile& file, const MeshOptions& options) {
  return read_foreign_mesh(file, {program, name.text}, options);
}
template <Reader program, ReaderName name>
VolumeFile grid_by(const InputFile& file, const VolumeOptions& options) {
  return read_foreign_volume(file, {program, name.text}, options);
}
template <Reader program, ReaderName name>
bool holds_grid_by(const InputFile& file) {
  return holds_one_grid(file, {program, name.text});
}
template <Reader program, ReaderName name>
scene::TimeStepRead steps_by(const InputFile& file, const MeshOptions& options) {
  return foreign_time_steps(file, {program, name.text}, options);
}

/// Reads VTK's XML files (.vtu .pvtu .vts .pvts .vtr .pvtr) and lists of them (.vtm .vtpc). Each piece of a .pvtu
/// becomes a block; the points of pieces are not merged.
cells::MeshBlocks read_vtk_xml(const InputFile& file, const MeshOptions& options);

/// Reads legacy .vtk files of unstructured, structured and rectilinear grids, ASCII or binary, with all arrays.
cells::MeshBlocks read_vtk_legacy(const InputFile& file, const MeshOptions& options);

/// Opens .vti .pvti .vtr .pvtr, and legacy .vtk of grids: in place, by parsing in this process, or by VTK.
VolumeFile open_vtk_grid(const InputFile& file, const VolumeOptions& options);

/// Reads Exodus II: all element blocks, and the nodal and element variables at one time step (default: the last). Nodes
/// keep their original positions (cells/warp.hpp). Variables NAME_x NAME_y NAME_z become one vector NAME.
cells::MeshBlocks read_exodus(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead exodus_time_steps(const InputFile& file, const MeshOptions& options);

/// Reads HDF5. The content of the file determines which kind of HDF5 file it is.
cells::MeshBlocks read_hdf5(const InputFile& file, const MeshOptions& options);

/// Readers of files of solvers. VTK's readers do not detect files of another kind under the name of a solver's file, so
/// these functions check the content.
cells::MeshBlocks read_openfoam(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_ensight(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_fluent(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_gambit(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_avs_ucd(const InputFile& file, const MeshOptions& options);

/// Reads a PLOT3D grid and solution. The binary layout is deduced from the size of the file. If `plot3d_q` is empty,
/// the solution is the file next to the grid with a matching name; if there is none, the mesh has no field. IBLANK 0 at
/// a point hides the cells that use the point.
cells::MeshBlocks read_plot3d(const InputFile& file, const MeshOptions& options);

/// Reads one time step, by default the last, of ParaView's list of PLOT3D files (.p3d, plot3d_list.hpp). `plot3d_q`
/// replaces the solution that the list names.
cells::MeshBlocks read_plot3d_list(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead plot3d_list_time_steps(const InputFile& file, const MeshOptions& options);

}  // namespace tessera::io
