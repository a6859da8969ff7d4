// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells/mesh_blocks.hpp"
#include "io/files/input_file.hpp"
#include "io/mesh/mesh_options.hpp"
#include "io/mesh/triangle_file.hpp"

/// Readers of mesh files, named by rows of the table of formats (io/formats/format_table.cpp). Readers that need a
/// reader program throw missing_reader() if the program is not installed.
namespace tessera::io {

struct ForeignFile;

cells::MeshBlocks read_medit_text(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_medit_binary(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_nastran_mesh(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_su2(const InputFile& file, const MeshOptions& options);

cells::MeshBlocks read_tecplot(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead tecplot_time_steps(const InputFile& file, const MeshOptions& options);

/// Reads the tets of a .tets file, with the file's field "scalar".
cells::MeshBlocks read_tets(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks blocks_of_tets(scene::TetMesh mesh);

/// Reads TetGen's mesh, given either of its files; the name of one file determines the other.
cells::MeshBlocks read_node_ele(const InputFile& file, const MeshOptions& options);

/// Reads a mesh with refinement levels. Cells covered by finer cells are left out; only the chosen field is read. Cell
/// data become voxels; point data, and cell data with `smooth`, become cells that connect across levels
/// (cells/amr/amr_cells.hpp).
cells::MeshBlocks read_amr_list(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_hyper_trees(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_amrex(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_enzo(const InputFile& file, const MeshOptions& options);

/// Like read_amr_list(), for a file whose reader reported refinement levels (ForeignContents::has_levels).
cells::MeshBlocks read_amr(ForeignFile blocks, const MeshOptions& options);

/// Readers of surfaces as stored in their files. Each triangle of an STL file has its own points.
SurfaceFile read_stl_surface(const InputFile& file);
SurfaceFile read_vtk_surface_file(const InputFile& file);
SurfaceFile read_ply_surface(const InputFile& file);
SurfaceFile read_tetgen_surface(const InputFile& file);

/// Reads a surface and fills it by TetGen with tets of at most `max_volume`, by default 1/30,000 of the enclosed
/// volume. Point fields: the attributes of the file, then "depth", the distance to the surface in world units.
cells::MeshBlocks fill_surface_file(const InputFile& file, const MeshOptions& options);

}  // namespace tessera::io
