// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/curved/higher_order_plan.hpp"
#include "cells/field_choice.hpp"
#include "cells/mesh_blocks.hpp"
#include "tessera/read_options.hpp"

namespace tessera::cells {

/// The result of assembling some blocks of a file.
struct AssembledBlocks {
  scene::TetMesh mesh;
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<std::string> notes;
  std::vector<std::uint64_t> cell_keys;  ///< duplicate_keys() of the mesh, if Duplicates::keys was requested
};

/// What to do with cells that have the same corners as earlier cells. For a part of a mesh `keys` is used, because
/// other parts may have the same cells.
enum class Duplicates : std::uint8_t { count, drop, keys };

/// Drops ghost, hidden and NaN cells and splits the rest into tets with the chosen field. Blocks are emptied as they
/// are used, so that nothing is held twice. A piece of a parallel file must have the field; other blocks without it are
/// blanked, with a note. Throws Error(bad_input) in one line that begins with the block's source or `source`. The mesh
/// and the error do not depend on the number of threads.
AssembledBlocks assemble_blocks(std::vector<CellBlock> blocks, std::span<const FieldSummary> fields,
                                const FieldChoice& choice, const std::string& source, const HigherOrderPlan& plan,
                                Duplicates duplicates = Duplicates::count);

/// Returns notes about how the cells of a whole file were treated. Throws Error(bad_input) if nothing remains to
/// render.
std::vector<std::string> notes_on_cells(const MeshCounts& counts, const HigherOrderCells& higher_order,
                                        const std::string& source);

/// Returns the differences between the cells that are drawn and those of the file, one line each.
std::vector<std::string> warnings_on_cells(const MeshCounts& counts, const HigherOrderCells& higher_order);

/// A function that determines how higher-order cells are divided: plan_higher_order(), or one that agrees with the
/// other parts of a mesh.
using HigherOrderPlanning =
    std::function<HigherOrderPlan(std::span<const CellBlock> blocks, const ReadOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields)>;

/// Creates the tet mesh of all blocks of a file: chooses the field, assembles the blocks, and smooths the field if
/// requested. `format` is left empty. Throws like assemble_blocks(), notes_on_cells() and choose_field().
MeshFile assemble_mesh(std::vector<CellBlock> blocks, const ReadOptions& options, const std::string& source,
                       const HigherOrderPlanning& planning = plan_higher_order);

/// Replaces cell data by point data: each used vertex gets the mean of the adjacent cells, weighted by tet volume
/// (unweighted if all volumes are 0). Coincident vertices count as one vertex, so that there is no seam between pieces.
void smooth_to_points(scene::TetMesh& mesh);

}  // namespace tessera::cells
