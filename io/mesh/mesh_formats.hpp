// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cells/block_choice.hpp"
#include "cells/cell_block.hpp"
#include "cells/mesh_blocks.hpp"
#include "cells/mesh_options.hpp"
#include "io/formats/file_kinds.hpp"
#include "tessera/read_progress.hpp"

namespace tessera::io {

struct ForeignFile;

// What programs under readers/ read throws missing_reader() where they are not installed.

/// VTK's XML files: .vtu .pvtu .vts .pvts .vtr .pvtr, and lists of them (.vtm .vtpc). The pieces of a .pvtu are a block
/// each, their points not merged.
cells::MeshBlocks read_vtk_xml(const std::filesystem::path& file, const cells::MeshOptions& options);

/// The tets of a .tets file, or a range of them, with their field "scalar".
cells::MeshBlocks blocks_of_tets(scene::TetMesh mesh);

/// Legacy .vtk: unstructured, structured and rectilinear grids, ASCII or binary, all their arrays.
cells::MeshBlocks read_vtk_legacy(const std::filesystem::path& file, const cells::MeshOptions& options);

/// Exodus II: all element blocks, nodal and element variables at one time step (default the last). Nodes are where
/// they began (cells/warp.hpp). Variables NAME_x NAME_y NAME_z become one vector NAME.
cells::MeshBlocks read_exodus(const std::filesystem::path& file, const cells::MeshOptions& options);

/// A file of a solver, by the name of a reader in readers/vtk/vtk_main.cpp: all blocks, all arrays, one time step, by
/// default the last. Grids become hexahedra.
cells::MeshBlocks read_solver_file(const std::filesystem::path& file, const char* reader,
                                   const cells::MeshOptions& options);

/// What Gmsh's library reads, by the name of a reader in readers/gmsh/gmsh_main.cpp: a block a physical group, one time
/// step, by default the last.
cells::MeshBlocks read_by_gmsh(const std::filesystem::path& file, const char* reader,
                               const cells::MeshOptions& options);

/// XDMF by its library: a block a grid, all attributes of nodes and cells, one time step, by default the last.
cells::MeshBlocks read_xdmf_mesh(const std::filesystem::path& file, const cells::MeshOptions& options);

/// MED by its library: a block a mesh, fields of nodes and cells, one time step, by default the last.
cells::MeshBlocks read_med(const std::filesystem::path& file, const cells::MeshOptions& options);

/// Meshes with levels of refinement, by the name of a reader in readers/vtk/vtk_main.cpp, or "amr_list", VTK's lists of
/// blocks. Cells that finer ones cover are left out; the chosen field alone is read. Cell data are voxels; point data
/// and `smooth` are cells that meet across levels (cells/amr/amr_cells.hpp).
cells::MeshBlocks read_amr(const std::filesystem::path& file, const char* reader, const cells::MeshOptions& options);

/// The same of a file that the helper found to be one (ForeignContents::has_levels).
cells::MeshBlocks read_amr(ForeignFile blocks, const cells::MeshOptions& options);

/// HDF5, by what is in it.
cells::MeshBlocks read_hdf5(const std::filesystem::path& file, const cells::MeshOptions& options);

/// PLOT3D grid and solution; the binary layout is found from the file's size. `plot3d_q` may be empty: then it is
/// looked for beside the grid by its name, and if there is none the mesh has no field. IBLANK 0 hides a point's cells.
cells::MeshBlocks read_plot3d(const std::filesystem::path& file, const cells::MeshOptions& options);

/// The same of one time of ParaView's list of such files (.p3d, plot3d_list.hpp), by default the last. `plot3d_q` takes
/// the place of the solution that it names.
cells::MeshBlocks read_plot3d_list(const std::filesystem::path& file, const cells::MeshOptions& options);

/// A surface (.stl .vtp .ply .poly .smesh) filled by TetGen with tets of at most `max_volume`, or of a 30,000th of what
/// it encloses. Point fields: "depth", the distance to the surface in world units, after the file's own attributes.
cells::MeshBlocks read_surface(const std::filesystem::path& file, FileKind kind, std::optional<double> max_volume,
                               const ReadProgressFunction& progress);

/// TetGen's mesh; either file's name finds the other.
cells::MeshBlocks read_node_ele(const std::filesystem::path& file);

}  // namespace tessera::io
