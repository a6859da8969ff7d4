// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cells/mesh_blocks.hpp"
#include "io/files/input_file.hpp"
#include "io/mesh/mesh_options.hpp"
#include "io/mesh/triangle_file.hpp"

/// What the rows of the table of formats (io/formats/format_table.cpp) name of this directory: readers of mesh files.
/// Those that need a reader program throw missing_reader() where it is not installed.
namespace tessera::io {

struct ForeignFile;

cells::MeshBlocks read_medit_text(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_medit_binary(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_nastran_mesh(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_su2(const InputFile& file, const MeshOptions& options);

cells::MeshBlocks read_tecplot(const InputFile& file, const MeshOptions& options);
scene::TimeStepRead tecplot_time_steps(const InputFile& file, const MeshOptions& options);

/// The tets of a .tets file, with their field "scalar".
cells::MeshBlocks read_tets(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks blocks_of_tets(scene::TetMesh mesh);

/// TetGen's mesh; either file's name finds the other.
cells::MeshBlocks read_node_ele(const InputFile& file, const MeshOptions& options);

/// Meshes with levels of refinement. Cells that finer ones cover are left out; the chosen field alone is read. Cell
/// data are voxels; point data and `smooth` are cells that meet across levels (cells/amr/amr_cells.hpp).
cells::MeshBlocks read_amr_list(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_hyper_trees(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_amrex(const InputFile& file, const MeshOptions& options);
cells::MeshBlocks read_enzo(const InputFile& file, const MeshOptions& options);

/// The same of a file that the helper found to be one (ForeignContents::has_levels).
cells::MeshBlocks read_amr(ForeignFile blocks, const MeshOptions& options);

/// Surfaces as their files have them. Triangles of STL have points of their own.
SurfaceFile read_stl_surface(const InputFile& file);
SurfaceFile read_vtk_surface_file(const InputFile& file);
SurfaceFile read_ply_surface(const InputFile& file);
SurfaceFile read_tetgen_surface(const InputFile& file);

/// A surface filled by TetGen with tets of at most `max_volume`, or of a 30,000th of what it encloses. Point fields:
/// "depth", the distance to the surface in world units, after the file's own attributes.
cells::MeshBlocks fill_surface_file(const InputFile& file, const MeshOptions& options);

}  // namespace tessera::io
