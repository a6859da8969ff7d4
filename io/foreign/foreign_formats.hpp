// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "io/foreign/client/foreign_file.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/volume/volume_reader.hpp"

/// Functions named by the rows of the table of formats for files that the reader programs read, as meshes and as
/// volumes. Some formats contain either; only their libraries can determine which. All throw missing_reader() if the
/// program is not installed.
namespace tessera::io {

/// The name of a reader in a program's main file under readers/, as a template argument.
struct ReaderName {
  template <std::size_t n>
  consteval ReaderName(const char (&name)[n]) {  // NOLINT(google-explicit-constructor): a literal stands for it
    std::copy_n(name, n, text);
  }
  char text[16]{};
};

/// A program under readers/, the name of a reader in it, and the remedy to report if it crashes.
struct ForeignReader {
  Reader program;
  const char* name;
  const char* remedy = nullptr;  ///< null: the same as for other files
};

/// All blocks and arrays of one time step, by default the last; grids become hexahedra.
cells::MeshBlocks read_foreign_mesh(const InputFile& file, const ForeignReader& by, const MeshOptions& options);

/// Opens the file as a volume. Throws Error(bad_input) for a mesh, and for a file that has the format only by its name,
/// except DICOM, whose files may lack the DICM mark.
VolumeFile read_foreign_volume(const InputFile& file, const ForeignReader& by, const VolumeOptions& options);

/// Whether the file contains exactly one regular or rectilinear grid and so is a volume; the helper inspects its
/// header. Also false if it cannot be read: opening it then reports why.
bool holds_one_grid(const InputFile& file, const ForeignReader& by);

/// The time steps that the helper finds when it opens a mesh.
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

/// VTK's XML files: .vtu .pvtu .vts .pvts .vtr .pvtr, and lists of them (.vtm .vtpc). Each piece of a .pvtu becomes a
/// block; their points are not merged.
cells::MeshBlocks read_vtk_xml(const InputFile& file, const MeshOptions& options);

/// Legacy .vtk: unstructured, structured and rectilinear grids, ASCII or binary, with all arrays.
cells::MeshBlocks read_vtk_legacy(const InputFile& file, const MeshOptions& options);

/// .vti .pvti .vtr .pvtr, and legacy .vtk of grids: in place, in this process or by VTK.
VolumeFile open_vtk_grid(const InputFile& file, const VolumeOptions& options);

/// Exodus II: all element blocks, nodal and element variables at one time step (default: the last). Nodes keep their
/// original positions (cells/warp.hpp). Variables NAME_x NAME_y NAME_z become one vector NAME.
cells::MeshBlocks read_exodus(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead exodus_time_steps(const InputFile& file, const MeshOptions& options);

/// HDF5; the content determines the kind.
cells::MeshBlocks read_hdf5(const InputFile& file, const MeshOptions& options);

/// Files of solvers. VTK's readers do not check the content of other files with these names, so this is checked here.
cells::MeshBlocks read_openfoam(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_ensight(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_fluent(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_gambit(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_avs_ucd(const InputFile& file, const MeshOptions& options);

/// PLOT3D grid and solution; the binary layout is deduced from the file's size. If `plot3d_q` is empty, the solution is
/// searched for next to the grid, by its name; without one the mesh has no field. IBLANK 0 hides the cells of a point.
cells::MeshBlocks read_plot3d(const InputFile& file, const MeshOptions& options);

/// The same for one time step of ParaView's list of such files (.p3d, plot3d_list.hpp), by default the last. `plot3d_q`
/// replaces the solution that the list names.
cells::MeshBlocks read_plot3d_list(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead plot3d_list_time_steps(const InputFile& file, const MeshOptions& options);

}  // namespace tessera::io
