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

/// What a file holds before its cells are split. Readers that take a choice of blocks read no others.
struct MeshBlocks {
  std::vector<CellBlock> blocks;
  std::vector<std::string> notes;
  std::string format;
  std::vector<std::string> block_names{};    ///< of all, those too that were not chosen; empty: of `blocks`
  std::vector<std::string> surface_names{};  ///< of surfaces next to the volume, which are left out
  std::vector<FieldSummary> fields{};  ///< of the file, where the blocks have the chosen one alone, as options ask
  scene::TimeStepRead time_step{};
  bool beside_degrees = false;  ///< x and y are degrees, z is a length
  glm::dvec3 axis_scale{1};     ///< that the points are multiplied by
};

/// Adds the notes that are not there yet: all pieces of a file may give rise to one.
void add_notes(const std::vector<std::string>& more, std::vector<std::string>& notes);

/// The mesh that a file became.
struct MeshFile {
  scene::TetMesh mesh;
  MeshCounts counts;
  HigherOrderCells higher_order;
  std::vector<FieldSummary> fields;
  std::vector<std::string> notes;     ///< one line each: what was chosen, or odd about the file
  std::vector<std::string> blocks;    ///< names of all that the file has, read or not
  std::vector<std::string> surfaces;  ///< names of the surfaces, which io/mesh/block_surface.hpp reads
  scene::TimeStepRead time_step{};
  glm::dvec3 axis_scale{1};  ///< that the points are multiplied by
  std::string format;        ///< "VTK XML unstructured grid", "PLOT3D", "TetGen .node/.ele", ...
};

}  // namespace tessera::cells
