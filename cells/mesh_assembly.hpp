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

/// What some blocks of a file become.
struct AssembledBlocks {
  scene::TetMesh mesh;
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<std::string> notes;
  std::vector<std::uint64_t> cell_keys;  ///< duplicate_keys(), of Duplicates::keys
};

/// What is done about cells with the corners of earlier ones. Of a part of a mesh keys are kept, since other parts may
/// have those cells.
enum class Duplicates : std::uint8_t { count, drop, keys };

/// Drops ghost, hidden and NaN cells and splits the rest into tets with the chosen one of the file's fields. Blocks are
/// emptied as they are used, so that no more than one copy of anything is held. A piece of a parallel file has to have
/// the field; other blocks without it are blanked, and a note says so. Throws Error(bad_input) in one line
/// that begins with the block's source or `source`. The mesh and the error are the same whatever the `threads` (0: all
/// cores).
AssembledBlocks assemble_blocks(std::vector<CellBlock> blocks, std::span<const FieldSummary> fields,
                                const FieldChoice& choice, const std::string& source, const HigherOrderPlan& plan,
                                int threads = 1, Duplicates duplicates = Duplicates::count);

/// Notes on what happened to the cells of a whole file. Throws Error(bad_input) if nothing is left to render.
std::vector<std::string> notes_on_cells(const MeshCounts& counts, const HigherOrderCells& higher_order,
                                        const std::string& source);

/// What of the cells is drawn otherwise than the file has it, one line each.
std::vector<std::string> warnings_on_cells(const MeshCounts& counts, const HigherOrderCells& higher_order);

/// How higher-order cells are divided: plan_higher_order(), or what the parts of a mesh agree on.
using HigherOrderPlanning =
    std::function<HigherOrderPlan(std::span<const CellBlock> blocks, const ReadOptions& options,
                                  const FieldChoice& choice, std::span<const FieldSummary> fields)>;

/// Makes the tet mesh of all of a file's blocks: chooses the field, assembles, smooths if asked. `format` is left
/// empty. Throws as the functions above and choose_field.
MeshFile assemble_mesh(std::vector<CellBlock> blocks, const ReadOptions& options, const std::string& source,
                       const HigherOrderPlanning& planning = plan_higher_order);

/// Replaces cell data by point data: each used vertex gets the mean of the cells that touch it, weighted by tet volume
/// (unweighted where all volumes are 0). Vertices at one position count as one, so that pieces leave no seam.
void smooth_to_points(scene::TetMesh& mesh);

}  // namespace tessera::cells
