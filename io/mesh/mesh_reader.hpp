// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>

#include "cells/mesh_blocks.hpp"
#include "io/files/input_file.hpp"
#include "io/mesh/mesh_options.hpp"
#include "scene/tet_mesh.hpp"

namespace tessera::io {

/// Reads a mesh of any format of the table (io/formats/format_table.cpp), or a gzip file of one, inflated into memory.
/// TetGen fills surfaces. Cells other than tets are split so that neighbours agree on every shared face by position,
/// even if they come from different pieces. Throws Error(bad_input) in one line for a missing, truncated, malformed or
/// empty file, an unknown format or field, or if no cell remains; Error(system_failure) if memory runs out. VTK's own
/// messages never reach stderr.
/// Does not apply `options.selection` (see cells::select). The caller applies `options.trace` and `options.threads`.
cells::MeshFile read_mesh(const InputFile& file, const ReadOptions& options = {});

/// Reads several files as the pieces of one mesh; their points are not merged. Each file must have the chosen field.
/// All pieces have the same axis scale. Throws like read_mesh.
cells::MeshFile read_mesh(std::span<const InputFile> files, const ReadOptions& options = {});

/// The cells of a file's chosen blocks before they are split, and the names of all its blocks. Throws like read_mesh,
/// but accepts a file without cells.
cells::MeshBlocks read_mesh_blocks(const InputFile& file, const MeshOptions& options);

/// Returns the number of time steps of a mesh file and their times. Does not read the mesh if the format stores the
/// times separately. Throws like read_mesh.
scene::TimeStepRead time_steps_of_mesh(const InputFile& file, const ReadOptions& options = {});

/// Whether read_mesh supports the format. True for rectilinear grids, too, although they are volumes as well.
bool is_mesh(const InputFile& file);

/// Throws Error(bad_input) for a file that is not a mesh: its format is unknown, not supported, or that of a grid.
void require_mesh(const InputFile& file);

/// Writes a .tets file with coordinates and point scalars as float32; doubles are rounded. The file appears by rename.
/// Throws Error(bad_input) for cell data, more than 2^31 - 1 points or values beyond float's range,
/// Error(system_failure) if writing fails.
void write_tets(const scene::TetMeshView& mesh, const std::filesystem::path& file);

/// Writes a VTK XML unstructured grid: appended raw data compressed by zlib, with double coordinates and scalars. Adds
/// a cell array "OriginalCellId" if tets were split from other cells. The file appears by rename. Throws
/// Error(system_failure).
void write_vtu(const scene::TetMeshView& mesh, const std::filesystem::path& file);

}  // namespace tessera::io
