// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "cells/cell_block.hpp"
#include "cells/field_summary.hpp"
#include "scene/tet_mesh.hpp"
#include "scene/time_step_read.hpp"

namespace tessera::cells {

/// The contents of a file before its cells are split. Readers that support a choice of blocks read only the chosen
/// blocks.
struct MeshBlocks {
  std::vector<CellBlock> blocks;
  std::vector<std::string> notes;
  std::string format;
  std::vector<std::string> block_names{};    ///< names of all blocks, including those not chosen; empty: as in `blocks`
  std::vector<std::string> surface_names{};  ///< names of surfaces that are left out because the file has a volume
  std::vector<FieldSummary> fields{};        ///< all fields of the file, if the reader loads only the chosen field
  scene::TimeStepRead time_step{};
  bool xy_in_degrees = false;  ///< x and y are degrees, z is a length
  glm::dvec3 axis_scale{1};    ///< factors applied to the points
};

/// Adds notes that are not in the list yet. All pieces of a file may produce the same note.
void add_notes(const std::vector<std::string>& more, std::vector<std::string>& notes);

/// A file converted to a tet mesh.
struct MeshFile {
  scene::TetMesh mesh;
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<FieldSummary> fields;
  std::vector<std::string> notes;     ///< one line each: what was chosen, or is unusual about the file
  std::vector<std::string> blocks;    ///< names of all blocks of the file, whether they were read or not
  std::vector<std::string> surfaces;  ///< names of the surfaces, which io/mesh/block_surface.hpp reads
  scene::TimeStepRead time_step{};
  glm::dvec3 axis_scale{1};  ///< factors applied to the points
  std::string format;        ///< "VTK XML unstructured grid", "PLOT3D", "TetGen .node/.ele", ...
};

}  // namespace tessera::cells
