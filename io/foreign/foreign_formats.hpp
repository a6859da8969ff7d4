// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>

#include "io/foreign/client/foreign_file.hpp"
#include "io/mesh/mesh_reader.hpp"
#include "io/volume/volume_reader.hpp"

/// What the rows of the table of formats name of files that the reader programs read, as meshes and as volumes; the
/// files of some formats are one or the other by what is in them, which their libraries alone can tell. All throw
/// missing_reader() where the program is not installed.
namespace tessera::io {

/// The name of a reader in a program's main file under readers/, as a template argument.
struct ReaderName {
  template <std::size_t n>
  consteval ReaderName(const char (&name)[n]) {  // NOLINT(google-explicit-constructor): a literal stands for it
    std::copy_n(name, n, text);
  }
  char text[16]{};
};

/// A program under readers/, the name of a reader in it, and what to do where it crashes.
struct ForeignReader {
  Reader program;
  const char* name;
  const char* remedy = nullptr;  ///< null: as of other files
};

/// All blocks, all arrays, one time step, by default the last; grids become hexahedra.
cells::MeshBlocks read_foreign_mesh(const InputFile& file, const ForeignReader& by, const MeshOptions& options);

/// As a volume. Throws Error(bad_input) for a mesh, and for a file that is of the format by its name alone, unless that
/// is DICOM's, whose files may lack a mark.
VolumeFile read_foreign_volume(const InputFile& file, const ForeignReader& by, const VolumeOptions& options);

/// Whether the file holds one regular or rectilinear grid, so that it is a volume: the helper looks at its header.
/// False too if it cannot be read: opening it then says why.
bool holds_one_grid(const InputFile& file, const ForeignReader& by);

/// The time steps that the helper finds as it opens a mesh.
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

/// VTK's XML files: .vtu .pvtu .vts .pvts .vtr .pvtr, and lists of them (.vtm .vtpc). The pieces of a .pvtu are a block
/// each, their points not merged.
cells::MeshBlocks read_vtk_xml(const InputFile& file, const MeshOptions& options);

/// Legacy .vtk: unstructured, structured and rectilinear grids, ASCII or binary, all their arrays.
cells::MeshBlocks read_vtk_legacy(const InputFile& file, const MeshOptions& options);

/// .vti .pvti .vtr .pvtr, and legacy .vtk of grids: in place, in this process or by VTK.
VolumeFile open_vtk_grid(const InputFile& file, const VolumeOptions& options);

/// Exodus II: all element blocks, nodal and element variables at one time step (default the last). Nodes are where
/// they began (cells/warp.hpp). Variables NAME_x NAME_y NAME_z become one vector NAME.
cells::MeshBlocks read_exodus(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead exodus_time_steps(const InputFile& file, const MeshOptions& options);

/// HDF5, by what is in it.
cells::MeshBlocks read_hdf5(const InputFile& file, const MeshOptions& options);

/// Files of solvers. VTK's readers do not check what other files of these names hold, so that it is done here.
cells::MeshBlocks read_openfoam(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_ensight(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_fluent(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_gambit(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_avs_ucd(const InputFile& file, const MeshOptions& options);

/// PLOT3D grid and solution; the binary layout is found from the file's size. `plot3d_q` may be empty: then it is
/// looked for beside the grid by its name, and if there is none the mesh has no field. IBLANK 0 hides a point's cells.
cells::MeshBlocks read_plot3d(const InputFile& file, const MeshOptions& options);

/// The same of one time of ParaView's list of such files (.p3d, plot3d_list.hpp), by default the last. `plot3d_q` takes
/// the place of the solution that it names.
cells::MeshBlocks read_plot3d_list(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead plot3d_list_time_steps(const InputFile& file, const MeshOptions& options);

}  // namespace tessera::io
